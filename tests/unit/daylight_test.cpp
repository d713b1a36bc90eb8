// SPDX-License-Identifier: Apache-2.0
#include "first_picture/daylight.h"

#include <gtest/gtest.h>

#include "first_picture/survey.h"
#include "scene/environment_sampling.h"
#include "scene/sky/sky_levels.h"
#include "shared/color.h"
#include "shared/constants.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

float degrees_up_luminance(const Environment& sky, float degrees) {
  return luminance(sky_radiance(sky, direction_from_angles(0.3f, glm::radians(degrees))));
}

TEST(DaySky, GivesLevelGroundItsLuminance) {
  const Environment sky = make_day_sky(2.0f);
  constexpr int kSamples = 4096;
  float sum = 0.0f;
  for (int i = 0; i < kSamples; ++i) {
    const vec2 u = glm::fract(plastic_sequence(static_cast<uint>(i)));
    const vec3 local = sample_cosine_hemisphere(u);
    sum += luminance(sky_radiance(sky, {local.x, local.z, local.y}));
  }
  EXPECT_NEAR(sum / kSamples, 2.0f * kDaySkyLuminance, 0.01f);
}

TEST(DaySky, IsBlueAboveAndHazyAtTheHorizon) {
  const Environment sky = make_day_sky(1.0f);
  const vec3 zenith = sky_radiance(sky, {0.0f, 1.0f, 0.0f});
  const vec3 horizon = sky_radiance(sky, direction_from_angles(0.3f, glm::radians(1.0f)));
  EXPECT_GT(zenith.b / zenith.r, 3.0f);
  EXPECT_LT(horizon.b / horizon.r, 1.6f);
  EXPECT_GT(luminance(horizon), 2.0f * luminance(zenith));
  // Without a step at the horizon, and the same all around
  EXPECT_NEAR(degrees_up_luminance(sky, -0.7f), degrees_up_luminance(sky, 0.7f), 0.1f);
  EXPECT_LT(degrees_up_luminance(sky, -10.0f), 0.6f * luminance(horizon));
  EXPECT_NEAR(sky_radiance(sky, {1.0f, 0.0f, 0.0f}).b, sky_radiance(sky, {0.0f, 0.0f, -1.0f}).b,
              1e-5f);
}

TEST(DaySky, HasNoPartThatIsSampledAsALight) {
  const Environment sky = make_day_sky(1.0f);
  EXPECT_FALSE(SkyLevels(sky).has_bright_part());
}

TEST(DaySky, IsRecognized) {
  Environment sky = make_day_sky(0.5f);
  sky.revision = 7;
  EXPECT_TRUE(is_day_sky(sky));
  Environment tinted = sky;
  tinted.radiance.g = 0.6f;
  EXPECT_FALSE(is_day_sky(tinted));
  sky.map.at(3, 3)[1] += 1.0f;
  EXPECT_FALSE(is_day_sky(sky));
  EXPECT_FALSE(is_day_sky({}));
}

}  // namespace
}  // namespace lambent
