// SPDX-License-Identifier: Apache-2.0
#include "scene/sky/bright_sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "scene/environment_sampling.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "support/bright_skies.h"

namespace lambent::bright_sky_test {
namespace {

constexpr std::uint32_t kDirections = 100000;

void expect_near(const glm::vec3& found, const glm::vec3& should, float share) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], should[k], share * should[k] + 1e-5f) << k;
}

TEST(BrightSky, AndTheDimRestAreTheWholeSky) {
  for (const Environment& environment : {test::checkered_sky(), test::sunny_sky()}) {
    const SkyLevels sky(environment);
    ASSERT_TRUE(sky.has_bright_part());
    for (std::uint32_t i = 0; i < kDirections; ++i) {
      const glm::vec3 direction = spherical_fibonacci(i, kDirections);
      const SkySeen seen = sky_seen(sky, direction, 0.0f);
      expect_near(seen.dim + seen.bright, sky_radiance(environment, direction), 1e-4f);
      EXPECT_EQ(seen.bright != glm::vec3(0.0f), seen.density > 0.0f) << i;
    }
  }
}

// Coarser levels have the light of the dim part alone, which is all of it but for the bright part.
TEST(BrightSky, IsNotInTheLevelsOfTheRest) {
  const Environment environment = test::sunny_sky();
  const SkyLevels sky(environment);
  for (const float angle : {0.05f, 0.3f, 1.0f}) {
    for (std::uint32_t i = 0; i < kDirections; i += 100) {
      const SkySeen seen = sky_seen(sky, spherical_fibonacci(i, kDirections), angle);
      EXPECT_LT(seen.dim.x, sky.bright_limit() + 1e-3f) << angle;
      EXPECT_GT(seen.dim.x, 0.499f) << angle;
    }
  }
}

TEST(BrightSky, SamplesHaveTheDensityThatRaysAreWeighedAgainst) {
  for (const Environment& environment : {test::checkered_sky(), test::sunny_sky()}) {
    const SkyLevels sky(environment);
    RandomStream random = make_random_stream(1, 2, 3);
    glm::dvec3 sampled(0.0), whole(0.0);
    for (std::uint32_t i = 0; i < kDirections; ++i) {
      const float u = next_uniform(random);
      const BrightSkySample drawn = sample_bright_sky(sky, u, next_uniform2(random));
      ASSERT_GT(drawn.pdf, 0.0f);
      sampled += glm::dvec3(drawn.radiance / drawn.pdf);
      const SkySeen seen = sky_seen(sky, drawn.direction_ws, 0.0f);
      if (i % 1000 != 0 || drawn.radiance == glm::vec3(0.0f)) continue;
      EXPECT_NEAR(seen.density / drawn.pdf, 1.0f, 0.05f) << i;
    }
    // Sum up the map over points that are finer than its texels
    constexpr int kRows = 1440, kColumns = 2 * kRows;
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        const glm::vec2 uv((static_cast<float>(x) + 0.5f) / kColumns,
                           (static_cast<float>(y) + 0.5f) / kRows);
        const glm::vec3 direction = direction_from_latitude_longitude(uv, environment.rotation);
        whole += glm::dvec3(sky_seen(sky, direction, 0.0f).bright * map_solid_angle(uv.y));
      }
    }
    sampled /= static_cast<double>(kDirections);
    whole /= static_cast<double>(kRows) * kColumns;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(sampled[k] / whole[k], 1.0, 0.01) << k;
  }
}

TEST(BrightSky, HasNoneWhereAllOfItIsAlike) {
  Environment environment;
  environment.radiance = glm::vec3(3.0f);
  EXPECT_FALSE(SkyLevels(environment).has_bright_part());
  environment.map = Image(64, 32, 3);
  EXPECT_FALSE(SkyLevels(environment).has_bright_part()) << "black";
  for (float& value : environment.map.pixels) value = 7.0f;
  const SkyLevels even(environment);
  EXPECT_FALSE(even.has_bright_part());
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  EXPECT_EQ(sky_seen(even, up, 0.5f).dim, sky_radiance_in_cone(even, up, 0.5f));
}

TEST(BrightSky, FollowsEditsOfTheMap) {
  Environment environment = test::sunny_sky();
  SkyLevels sky(environment);
  for (float& value : environment.map.pixels) value = 1.0f;
  ++environment.revision;
  sky.update();
  EXPECT_FALSE(sky.has_bright_part());
}

// By chance few rays of rough coats find a small sun, and each that does would be a speck.
TEST(BrightSky, IsReflectedByRoughCoatsWithoutSpecks) {
  for (const float clearcoat : {0.0f, 1.0f}) {
    const test::Stage stage = test::ball_under_the_sun(0.4f, clearcoat);
    const IrradianceField field = test::field_of_ball(stage);
    FrameSettings settings = quality_settings(Quality::interactive);
    settings.width = settings.height = 64;
    settings.gather_rays = 0;
    settings.glossy_rows = 1;
    const auto picture = [&](int samples, std::uint32_t seed) {
      settings.samples = samples;
      settings.seed = seed;
      Renderer renderer(stage.world, {.field = &field});
      return renderer.render(stage.scene.cameras.at(0), settings).value().image;
    };
    const LayeredImage few_samples = picture(4, 1), many = picture(32, 2);
    const Metrics noise =
        compare_images(*few_samples.find("glossy"), *many.find("glossy"), {}).value();
    // By rays alone FLIP is 0.029, and means of other seeds are off by up to 23 %
    EXPECT_LT(noise.flip, 0.02) << clearcoat;
    EXPECT_NEAR(noise.mean_ratio, 1.0, 0.05) << clearcoat;
  }
}

}  // namespace
}  // namespace lambent::bright_sky_test
