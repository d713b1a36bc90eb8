// SPDX-License-Identifier: Apache-2.0
#include "scene/environment_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shared/constants.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "support/chi_squared.h"

namespace lambent::environment_sampling_test {
namespace {

constexpr int kSamples = 200000;

// A dim sky with a small sun.
Environment sunny() {
  Environment environment;
  environment.radiance = glm::vec3(1.0f);
  environment.map = Image(32, 16, 3);
  for (float& value : environment.map.pixels) value = 0.1f;
  for (int k = 0; k < 3; ++k) environment.map.at(20, 4)[k] = 50.0f;
  environment.rotation = 0.7f;
  return environment;
}

TEST(EnvironmentMap, DirectionsRoundTrip) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const glm::vec3 direction = spherical_fibonacci(i, 1000);
    const glm::vec2 uv = latitude_longitude_from_direction(direction, 0.7f);
    EXPECT_NEAR(glm::length(direction_from_latitude_longitude(uv, 0.7f) - direction), 0.0f, 2e-3f);
  }
}

TEST(EnvironmentMap, MiddleLooksAlongMinusZAndPlusXIsToTheRight) {
  EXPECT_NEAR(
      glm::length(latitude_longitude_from_direction({0.0f, 0.0f, -1.0f}, 0.0f) - glm::vec2(0.5f)),
      0.0f, 1e-6f);
  EXPECT_NEAR(latitude_longitude_from_direction({1.0f, 0.0f, 0.0f}, 0.0f).x, 0.75f, 1e-6f);
  EXPECT_NEAR(latitude_longitude_from_direction({0.0f, 1.0f, 0.0f}, 0.0f).y, 0.0f, 1e-3f);
}

TEST(EnvironmentMap, RotationTurnsTheSkyCounterClockwiseSeenFromAbove) {
  // What was at -Z turns to -X
  const glm::vec3 turned = direction_from_latitude_longitude({0.5f, 0.5f}, 0.5f * kPi);
  EXPECT_NEAR(glm::length(turned - glm::vec3(-1.0f, 0.0f, 0.0f)), 0.0f, 1e-6f);
}

TEST(EnvironmentMap, ReadsItsTexelCentresAndWrapsAround) {
  Image map(4, 2, 3);
  for (int x = 0; x < 4; ++x) map.at(x, 0)[0] = static_cast<float>(x);
  EXPECT_FLOAT_EQ(sample_environment_map(map, {0.375f, 0.25f}).x, 1.0f);
  EXPECT_FLOAT_EQ(sample_environment_map(map, {0.0f, 0.25f}).x, 1.5f);
}

TEST(EnvironmentDistribution, SampleAndDensityAgree) {
  const Environment environment = sunny();
  const EnvironmentDistribution distribution(environment);
  RandomStream random = make_random_stream(1u, 0u, 0u);
  for (int i = 0; i < 1000; ++i) {
    const EnvironmentSample sample = distribution.sample(next_uniform2(random));
    EXPECT_NEAR(distribution.pdf(sample.direction_ws) / sample.pdf, 1.0f, 0.02f);
    EXPECT_NEAR(glm::length(sky_radiance(environment, sample.direction_ws) - sample.radiance), 0.0f,
                0.05f);
  }
}

TEST(EnvironmentDistribution, FollowsItsDensity) {
  const Environment environment = sunny();
  const EnvironmentDistribution distribution(environment);
  constexpr int kCellsU = 64, kCellsV = 32;  // finer than the map, on its borders
  std::vector<double> observed(kCellsU * kCellsV), expected(kCellsU * kCellsV);
  RandomStream random = make_random_stream(2u, 0u, 0u);
  for (int i = 0; i < kSamples; ++i) {
    const glm::vec2 uv = latitude_longitude_from_direction(
        distribution.sample(next_uniform2(random)).direction_ws, environment.rotation);
    observed[std::min(static_cast<int>(uv.y * kCellsV), kCellsV - 1) * kCellsU +
             static_cast<int>(uv.x * kCellsU)] += 1.0;
  }
  double total = 0.0;
  for (int v = 0; v < kCellsV; ++v) {
    for (int u = 0; u < kCellsU; ++u) {
      const glm::vec2 uv((static_cast<float>(u) + 0.5f) / kCellsU,
                         (static_cast<float>(v) + 0.5f) / kCellsV);
      const double solid_angle = 2.0 * kPi * kPi * std::sin(kPi * uv.y) / (kCellsU * kCellsV);
      const double share =
          distribution.pdf(direction_from_latitude_longitude(uv, environment.rotation)) *
          solid_angle;
      expected[v * kCellsU + u] = share * kSamples;
      total += share;
    }
  }
  EXPECT_NEAR(total, 1.0, 1e-3);
  EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation);
}

TEST(EnvironmentDistribution, IntegratesTheSky) {
  const Environment environment = sunny();
  const EnvironmentDistribution distribution(environment);
  RandomStream random = make_random_stream(3u, 0u, 0u);
  double drawn = 0.0, uniform = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const EnvironmentSample sample = distribution.sample(next_uniform2(random));
    drawn += sample.radiance.x / sample.pdf / kSamples;
    uniform +=
        sky_radiance(environment, spherical_fibonacci(static_cast<std::uint32_t>(i), kSamples)).x *
        4.0 * kPi / kSamples;
  }
  EXPECT_NEAR(drawn / uniform, 1.0, 0.01);
}

TEST(EnvironmentDistribution, IsEmptyForConstantAndBlackSkies) {
  Environment constant;
  constant.radiance = glm::vec3(1.0f);
  EXPECT_TRUE(EnvironmentDistribution(constant).empty());
  Environment black;
  black.radiance = glm::vec3(1.0f);
  black.map = Image(4, 2, 3);
  EXPECT_TRUE(EnvironmentDistribution(black).empty());
  EXPECT_EQ(EnvironmentDistribution(black).sample({0.5f, 0.5f}).pdf, 0.0f);
}

}  // namespace
}  // namespace lambent::environment_sampling_test
