// SPDX-License-Identifier: Apache-2.0
// Based on: Ottosson, "A Perceptual Color Space for Image Processing" (Oklab), 2020. The maps are
// curves of even lightness in it that stay inside Rec. 709; Moreland, "Diverging Color Maps for
// Scientific Visualization", 2009, says why the middle is pale.
#include "core/image/color_map.h"

#include <algorithm>
#include <cmath>

#include "shared/color.h"

namespace lambent {
namespace {

/// Ottosson 2020: linear Rec. 709 of a lightness, a chroma and a hue [degrees].
vec3 linear_from_oklch(float lightness, float chroma, float hue_degrees) {
  const float hue = glm::radians(hue_degrees);
  const float a = chroma * std::cos(hue);
  const float b = chroma * std::sin(hue);
  const float long_root = lightness + 0.3963377774f * a + 0.2158037573f * b;
  const float medium_root = lightness - 0.1055613458f * a - 0.0638541728f * b;
  const float short_root = lightness - 0.0894841775f * a - 1.2914855480f * b;
  const vec3 cones(long_root * long_root * long_root, medium_root * medium_root * medium_root,
                   short_root * short_root * short_root);
  return vec3(dot(cones, vec3(4.0767416621f, -3.3077115913f, 0.2309699292f)),
              dot(cones, vec3(-1.2684380046f, 2.6097574011f, -0.3413193965f)),
              dot(cones, vec3(-0.0041960863f, -0.7034186147f, 1.7076147010f)));
}

glm::vec3 encoded(const vec3& linear) {
  return srgb_from_linear(clamp(linear, vec3(0.0f), vec3(1.0f)));
}

// The sequential map: lightness and hue run linearly, chroma swells in the middle where the gamut
// is wide.
constexpr float kDarkest = 0.12f, kLightest = 0.97f;
constexpr float kViolet = 285.0f,
                kYellow = 465.0f;  // Degrees; 465 is 105 after a full turn, through red.
constexpr float kEndChroma = 0.05f, kMidChroma = 0.17f;

// The diverging map: both arms run from near-white to a dark, saturated hue.
constexpr float kNeutralLightness = 0.96f, kArmLightness = 0.46f;
constexpr float kArmChroma = 0.18f;
constexpr float kBlue = 262.0f, kRed = 29.0f;

}  // namespace

glm::vec3 sequential_color(float value) {
  const float t = std::clamp(value, 0.0f, 1.0f);
  const float swell = 4.0f * t * (1.0f - t);
  return encoded(linear_from_oklch(mix(kDarkest, kLightest, t), mix(kEndChroma, kMidChroma, swell),
                                   mix(kViolet, kYellow, t)));
}

glm::vec3 diverging_color(float value) {
  const float t = std::clamp(value, -1.0f, 1.0f);
  const float size = std::abs(t);
  return encoded(linear_from_oklch(mix(kNeutralLightness, kArmLightness, size), kArmChroma * size,
                                   t < 0.0f ? kBlue : kRed));
}

}  // namespace lambent
