// SPDX-License-Identifier: Apache-2.0
#include "scene/sky/sky_levels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/environment_sampling.h"
#include "shared/constants.h"
#include "shared/sampling.h"

namespace lambent::sky_levels_test {
namespace {

constexpr int kDirections = 20000;

/// A dim sky of this size with a bright patch, which is as wide as the texels of a 16th of it.
Environment with_a_lamp(int width, int height) {
  Environment environment;
  environment.radiance = glm::vec3(2.0f);
  environment.map = Image(width, height, 3);
  for (float& value : environment.map.pixels) value = 0.5f;
  for (int y = height / 4; y < height / 4 + height / 8; ++y) {
    for (int x = width / 2; x < width / 2 + width / 16; ++x) environment.map.at(x, y)[1] = 40.0f;
  }
  return environment;
}

/// Mean over the sphere of what cones of this angle see.
glm::dvec3 mean_seen(const SkyLevels& sky, float angle) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t i = 0; i < kDirections; ++i) {
    const glm::vec3 direction = spherical_fibonacci(i, kDirections);
    sum += glm::dvec3(sky_radiance_in_cone(sky, direction, angle));
  }
  return sum / static_cast<double>(kDirections);
}

TEST(SkyLevels, ConesNarrowerThanTexelsSeeTheMap) {
  const Environment environment = with_a_lamp(64, 32);
  const SkyLevels sky(environment);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const glm::vec3 direction = spherical_fibonacci(i, 1000);
    EXPECT_EQ(sky_radiance_in_cone(sky, direction, 0.9f * kPi / 32.0f),
              sky_radiance(environment, direction));
  }
}

TEST(SkyLevels, KeepTheMeanOverTheSphereForConesOfAnyWidth) {
  for (const glm::ivec2 size : {glm::ivec2(64, 32), glm::ivec2(100, 50), glm::ivec2(37, 23)}) {
    const Environment environment = with_a_lamp(size.x, size.y);
    const SkyLevels sky(environment);
    const glm::dvec3 exact = mean_seen(sky, 0.0f);
    for (const float angle : {0.1f, 0.2f, 0.5f, 1.0f, 3.0f}) {
      const glm::dvec3 mean = mean_seen(sky, angle);
      EXPECT_NEAR(mean.x, 1.0, 1e-4) << size.x << ": " << angle;
      EXPECT_NEAR(mean.y / exact.y, 1.0, 0.04) << size.x << ": " << angle;
    }
  }
}

TEST(SkyLevels, WiderConesSeeALampDimmerAndFromFartherOff) {
  const Environment environment = with_a_lamp(64, 32);
  const SkyLevels sky(environment);
  const glm::vec3 at = direction_from_latitude_longitude({0.53f, 0.31f}, 0.0f);
  const glm::vec3 beside = direction_from_latitude_longitude({0.62f, 0.31f}, 0.0f);
  float at_lamp = 80.0f, near_lamp = 1.0f;
  EXPECT_FLOAT_EQ(sky_radiance_in_cone(sky, at, 0.01f).y, at_lamp);
  EXPECT_FLOAT_EQ(sky_radiance_in_cone(sky, beside, 0.01f).y, near_lamp);
  for (const float angle : {0.4f, 0.7f, 1.2f}) {
    EXPECT_LT(sky_radiance_in_cone(sky, at, angle).y, at_lamp) << angle;
    at_lamp = sky_radiance_in_cone(sky, at, angle).y;
  }
  EXPECT_GT(sky_radiance_in_cone(sky, beside, 0.7f).y, 1.5f * near_lamp);
}

TEST(SkyLevels, FollowEditsOfTheMap) {
  Environment environment = with_a_lamp(64, 32);
  SkyLevels sky(environment);
  for (float& value : environment.map.pixels) value = 3.0f;
  ++environment.revision;
  sky.update();
  EXPECT_FLOAT_EQ(sky_radiance_in_cone(sky, {0.0f, 1.0f, 0.0f}, 1.0f).y, 6.0f);
  environment.map = Image{};
  sky.update();
  EXPECT_EQ(sky_radiance_in_cone(sky, {0.0f, 1.0f, 0.0f}, 1.0f), environment.radiance);
}

}  // namespace
}  // namespace lambent::sky_levels_test
