// SPDX-License-Identifier: Apache-2.0
#include "first_picture/studio.h"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "first_picture/survey.h"
#include "scene/latitude_longitude.h"
#include "shared/color.h"

namespace lambent {
namespace {

// Size of the studio's map [texels]: the edges of the soft boxes take some ten of them.
constexpr int kMapWidth = 256, kMapHeight = 128;

// The neutral surrounding: radiance above, at the horizon and below [W/(m^2 sr)].
constexpr float kCeilingRadiance = 1.2f, kHorizonRadiance = 0.45f, kFloorRadiance = 0.3f;

// A soft box: its direction from the subject [degrees], with the azimuth from the camera to its
// right; half its width and height [degrees]; and its radiance [W/(m^2 sr)].
struct SoftBox {
  float azimuth, elevation, half_width, half_height, radiance;
};
// As photographers place them: the key above the camera's left shoulder, a weaker fill opposite,
// and a rim behind the subject that separates it from the background. All are outside the frame.
constexpr SoftBox kKey{-48.0f, 48.0f, 22.0f, 18.0f, 14.0f};
constexpr SoftBox kFill{62.0f, 22.0f, 20.0f, 24.0f, 3.0f};
constexpr SoftBox kRim{155.0f, 58.0f, 24.0f, 12.0f, 10.0f};
// Angle over which a soft box fades to its edge [degrees].
constexpr float kSoftEdge = 7.0f;

// Irradiance of make_key_light() on a surface that faces it [W/m^2], equal to that of the key's
// soft box.
constexpr float kKeyIrradiance = 5.0f;

/// 1 within `half` of the middle, falling to 0 over kSoftEdge.
float edge(float offset, float half) {
  return 1.0f - glm::smoothstep(half - kSoftEdge, half, std::abs(offset));
}

/// Share of a soft box's radiance in a direction, given by its angles [degrees].
float soft_box(const SoftBox& box, float azimuth, float elevation) {
  const float across =
      std::remainder(azimuth - box.azimuth, 360.0f) * std::cos(glm::radians(elevation));
  return edge(across, box.half_width) * edge(elevation - box.elevation, box.half_height);
}

float azimuth_of(const glm::vec3& direction) {
  return std::atan2(direction.x, direction.z);
}

}  // namespace

Environment make_studio(const glm::vec3& front_ws) {
  const float front = azimuth_of(front_ws);
  Environment studio;
  studio.radiance = glm::vec3(1.0f);
  studio.map = Image(kMapWidth, kMapHeight, 3);
  for (int y = 0; y < kMapHeight; ++y) {
    for (int x = 0; x < kMapWidth; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / kMapWidth,
                         (static_cast<float>(y) + 0.5f) / kMapHeight);
      const glm::vec3 direction = direction_from_latitude_longitude(uv, 0.0f);
      const float elevation = glm::degrees(std::asin(glm::clamp(direction.y, -1.0f, 1.0f)));
      const float azimuth = glm::degrees(azimuth_of(direction) - front);
      const float up = direction.y;
      float radiance =
          up >= 0.0f ? glm::mix(kHorizonRadiance, kCeilingRadiance, up)
                     : glm::mix(kHorizonRadiance, kFloorRadiance, glm::smoothstep(0.0f, 1.0f, -up));
      for (const SoftBox& box : {kKey, kFill, kRim}) {
        radiance += box.radiance * soft_box(box, azimuth, elevation);
      }
      for (int c = 0; c < 3; ++c) studio.map.at(x, y)[c] = radiance;
    }
  }
  return studio;
}

Light make_key_light(const glm::vec3& front_ws) {
  Light key;
  key.name = "key";
  key.type = Light::Type::directional;
  key.direction_ws = -direction_from_angles(azimuth_of(front_ws) + glm::radians(kKey.azimuth),
                                            glm::radians(kKey.elevation));
  key.intensity = glm::vec3(kKeyIrradiance);
  return key;
}

}  // namespace lambent
