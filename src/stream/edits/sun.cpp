// SPDX-License-Identifier: Apache-2.0
#include "stream/edits/sun.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambent::stream {
namespace {

/// Angle of the sun along its daily circle, 0 at sunrise [rad].
float angle_of(float hours) {
  constexpr float kSunrise = 6.0f, kHoursOfDay = 24.0f;
  return (hours - kSunrise) / kHoursOfDay * 2.0f * std::numbers::pi_v<float>;
}

}  // namespace

glm::vec3 sun_direction(float hours) {
  // At an equinox the circle is tilted from the zenith by the latitude
  constexpr float kLatitude = std::numbers::pi_v<float> / 4.0f;
  const float angle = angle_of(hours);
  const glm::vec3 to_sun(std::cos(angle), std::sin(angle) * std::cos(kLatitude),
                         std::sin(angle) * std::sin(kLatitude));
  return glm::normalize(-to_sun);
}

float sun_share(float hours) {
  // Full irradiance from about four degrees above the horizon on
  constexpr float kFullHeight = 0.07f;
  return std::clamp(-sun_direction(hours).y / kFullHeight, 0.0f, 1.0f);
}

}  // namespace lambent::stream
