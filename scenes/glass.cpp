// SPDX-License-Identifier: Apache-2.0
// A room that is lit through a pane: the part to the right of the pane is lit only by transmitted
// light.
#include <cmath>
#include <vector>

#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "scenes/recipes.h"
#include "shared/constants.h"

namespace lambent::scenes {
namespace {

constexpr glm::vec3 kGlassRoomMin{-2.0f, 0.0f, -1.5f};
constexpr glm::vec3 kGlassRoomMax{2.0f, 2.5f, 1.5f};
constexpr float kPane = -0.6f;  // where it stands [m along X]
constexpr glm::vec3 kPaneTint{0.75f, 0.95f, 0.85f};
constexpr glm::vec3 kBallCentre{0.35f, 0.7f, -0.35f};
constexpr float kBallRadius = 0.45f;                  // [m]
constexpr glm::vec3 kAmber{0.1f, 0.6f, 2.0f};         // absorption [1/m]
constexpr glm::vec3 kGlassLamp{14.0f, 13.0f, 11.0f};  // [W/(m^2 sr)]
constexpr int kBallSteps = 48;
constexpr float kGlassFieldOfView = 0.96f;  // [rad]

int add_glass(Scene& scene, const char* name, const glm::vec3& tint) {
  Material glass;
  glass.name = name;
  glass.base_color = glm::vec4(tint, 1.0f);
  glass.metallic = 0.0f;
  glass.roughness = 0.0f;
  glass.transmission = 1.0f;
  scene.materials.push_back(glass);
  return static_cast<int>(scene.materials.size()) - 1;
}

}  // namespace

AnimatedScene make_glass() {
  Scene scene;
  const int white = add_lambert(scene, "white", glm::vec3(0.75f));
  const int red = add_lambert(scene, "red", {0.65f, 0.12f, 0.08f});
  const int lamp = add_lambert(scene, "lamp", glm::vec3(0.0f), kGlassLamp);
  MeshBuilder builder;
  builder.room(kGlassRoomMin, kGlassRoomMax);
  add_object(scene, builder.take("room", white));
  builder.box({1.2f, 0.0f, -1.2f}, {1.6f, 1.2f, -0.8f},
              MeshBuilder::kAllFaces & ~MeshBuilder::kBottom);
  add_object(scene, builder.take("post", red));
  builder.quad({-1.6f, 2.49f, -0.4f}, {-1.0f, 2.49f, -0.4f}, {-1.0f, 2.49f, 0.4f},
               {-1.6f, 2.49f, 0.4f});
  add_object(scene, builder.take("lamp", lamp));

  const int pane = add_glass(scene, "pane", kPaneTint);
  builder.quad({kPane, kGlassRoomMin.y, kGlassRoomMax.z}, {kPane, kGlassRoomMin.y, kGlassRoomMin.z},
               {kPane, kGlassRoomMax.y, kGlassRoomMin.z},
               {kPane, kGlassRoomMax.y, kGlassRoomMax.z});
  add_object(scene, builder.take("pane", pane));
  const int ball = add_glass(scene, "ball", glm::vec3(1.0f));
  scene.materials[ball].bounds_volume = true;
  scene.materials[ball].absorption = kAmber;
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= kBallSteps; ++i) {
    const float angle = kPi * static_cast<float>(i) / kBallSteps;
    const bool pole = i == 0 || i == kBallSteps;
    profile.emplace_back(pole ? 0.0f : kBallRadius * std::sin(angle),
                         -kBallRadius * std::cos(angle));
  }
  builder.lathe(kBallCentre, profile, 2 * kBallSteps);
  add_object(scene, builder.take("ball", ball));
  add_camera(scene, "room", {1.75f, 1.5f, 1.3f}, {-0.7f, 0.8f, -0.6f}, kGlassFieldOfView,
             16.0f / 9.0f);
  return {std::move(scene), {}};
}

}  // namespace lambent::scenes
