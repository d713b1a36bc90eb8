// SPDX-License-Identifier: Apache-2.0
#include "first_picture/daylight.h"

#include <algorithm>
#include <cmath>

#include "scene/latitude_longitude.h"
#include "shared/color.h"

namespace lambent {
namespace {

// Size of the sky's map [texels]: a row is 1.4 degrees high.
constexpr int kSkyColumns = 256, kSkyRows = 128;
// A clear sky's luminance is in proportion to 1 - exp(-kGradation / sin(elevation)), but for the
// light around the sun: type 11, "white-blue sky with distinct solar corona", of the CIE's
// standard skies (ISO 15469:2004, table 1). Bluer types have a horizon that is over twice as bright
// as all of the map in the mean; that part would be sampled as a light.
constexpr float kGradation = 0.55f;
// Least sine of elevation in that formula, whose exponential is 0 long before.
constexpr float kMinUp = 1e-3f;
// Colours of the sky above and at the horizon, with a luminance of about 1: as blue as a clear sky,
// and about 7,500 K.
constexpr glm::vec3 kZenithColor{0.6f, 1.0f, 2.2f}, kHorizonColor{0.9f, 1.0f, 1.25f};
// What the ground reflects of sun and sky, through haze: radiance of an albedo of 0.15
// [W/(m^2 sr)]. It is neutral, for what is seen from above has it as its background.
constexpr glm::vec3 kGroundRadiance{0.88f, 0.9f, 0.93f};
// Haze hides the far ground: down to so many degrees below the horizon.
constexpr float kHazeAngle = 7.0f;

/// Luminance of the sky at a sine of elevation, over that at the horizon.
float gradation(float up) {
  return 1.0f - std::exp(-kGradation / std::max(up, kMinUp));
}

/// Radiance of the sky at a sine of elevation of at least 0, over the luminance of the horizon.
glm::vec3 sky_color(float up) {
  const float luminance = gradation(up), least = gradation(1.0f);
  const float haze = (luminance - least) / (1.0f - least);
  return luminance * glm::mix(kZenithColor, kHorizonColor, haze * haze);
}

float up_of_row(int y) {
  const float v = (static_cast<float>(y) + 0.5f) / kSkyRows;
  return direction_from_latitude_longitude({0.0f, v}, 0.0f).y;
}

/// Luminance of the horizon under which the sky gives horizontal surfaces kDaySkyLuminance.
float horizon_luminance() {
  float received = 0.0f, cosines = 0.0f;
  for (int y = 0; y < kSkyRows / 2; ++y) {
    const float up = up_of_row(y);
    const float weight = up * std::sqrt(1.0f - up * up);
    received += weight * luminance(sky_color(up));
    cosines += weight;
  }
  return kDaySkyLuminance * cosines / received;
}

Image make_map() {
  const float horizon = horizon_luminance();
  Image map(kSkyColumns, kSkyRows, 3);
  for (int y = 0; y < kSkyRows; ++y) {
    const float up = up_of_row(y);
    const float ground = glm::smoothstep(0.0f, std::sin(glm::radians(kHazeAngle)), -up);
    const glm::vec3 radiance =
        glm::mix(horizon * sky_color(std::max(up, 0.0f)), kGroundRadiance, ground);
    for (int x = 0; x < kSkyColumns; ++x) {
      for (int c = 0; c < 3; ++c) map.at(x, y)[c] = radiance[c];
    }
  }
  return map;
}

const Image& day_map() {
  static const Image map = make_map();
  return map;
}

}  // namespace

Light make_day_sun(const glm::vec3& direction_ws) {
  Light sun;
  sun.name = "sun";
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::normalize(direction_ws);
  sun.intensity = kDaySunIrradiance;
  return sun;
}

Environment make_day_sky(float brightness) {
  Environment sky;
  sky.radiance = glm::vec3(brightness);
  sky.map = day_map();
  return sky;
}

bool is_day_sky(const Environment& environment) {
  const glm::vec3& brightness = environment.radiance;
  return brightness == glm::vec3(brightness.x) && environment.rotation == 0.0f &&
         environment.map.width == kSkyColumns && environment.map.pixels == day_map().pixels;
}

float sun_ratio(const Scene& scene) {
  float suns = 0.0f;
  for (const Light& light : scene.lights) {
    if (light.type == Light::Type::directional) suns += luminance(light.intensity);
  }
  return suns / luminance(kDaySunIrradiance);
}

}  // namespace lambent
