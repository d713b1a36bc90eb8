// SPDX-License-Identifier: Apache-2.0
// Closed-form scenes whose radiance does not depend on geometry; builtin.h derives the values.
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "scenes/recipes.h"

namespace lambent::scenes {
namespace {

constexpr glm::vec3 kAlbedo{0.5f};
constexpr glm::vec3 kEmission{0.5f};

constexpr glm::vec3 kFurnaceRoomMin{-3.0f, 0.0f, -2.0f};
constexpr glm::vec3 kFurnaceRoomMax{3.0f, 3.0f, 2.0f};
constexpr float kFurnaceSphereRadius = 0.6f;
constexpr int kFurnaceSphereSegments = 32;
constexpr int kSphereRings = 16;
constexpr float kFurnaceFieldOfView = 1.0471976f;  // 60 degrees [rad]

}  // namespace

AnimatedScene make_furnace() {
  Scene scene;
  const int glowing = add_lambert(scene, "glowing", kAlbedo, kEmission);
  MeshBuilder builder;

  builder.room(kFurnaceRoomMin, kFurnaceRoomMax);
  add_object(scene, builder.take("room", glowing));

  // The pillar reaches from floor to ceiling and the crate stands on the floor, so hidden faces are
  // omitted.
  builder.box({1.2f, kFurnaceRoomMin.y, -1.1f}, {1.6f, kFurnaceRoomMax.y, -0.7f},
              MeshBuilder::kAllFaces & ~(MeshBuilder::kTop | MeshBuilder::kBottom));
  add_object(scene, builder.take("pillar", glowing));
  builder.box({-2.2f, kFurnaceRoomMin.y, -1.4f}, {-1.2f, 1.0f, -0.4f},
              MeshBuilder::kAllFaces & ~MeshBuilder::kBottom);
  add_object(scene, builder.take("crate", glowing));

  // A second crate hangs askew and a sphere floats: both closed.
  builder.box(glm::vec3(-0.35f), glm::vec3(0.35f));
  const glm::mat4 placed = glm::translate(glm::mat4(1.0f), {1.9f, 1.4f, 0.8f});
  const glm::vec3 axis = glm::normalize(glm::vec3(1.0f, 2.0f, 0.5f));
  constexpr float kTilt = 0.7f;  // [rad]
  add_object(scene, builder.take("hanging_crate", glowing), glm::rotate(placed, kTilt, axis));
  builder.faceted_sphere({-0.4f, 1.2f, 0.4f}, kFurnaceSphereRadius, kFurnaceSphereSegments,
                         kSphereRings);
  add_object(scene, builder.take("sphere", glowing));

  add_camera(scene, "furnace", {-2.7f, 1.7f, 1.7f}, {0.6f, 1.2f, -0.4f}, kFurnaceFieldOfView,
             kAspect);
  return {std::move(scene), {}};
}

AnimatedScene make_furnace_sky() {
  Scene scene;
  const int grey = add_lambert(scene, "grey", kAlbedo);
  MeshBuilder builder;
  builder.faceted_sphere(glm::vec3(0.0f), 1.0f, kFurnaceSphereSegments, kSphereRings);
  add_object(scene, builder.take("sphere", grey));
  scene.environment.radiance = glm::vec3(1.0f);
  add_camera(scene, "sphere", {0.0f, 0.0f, 3.0f}, glm::vec3(0.0f), kFurnaceFieldOfView, 1.0f);
  return {std::move(scene), {}};
}

}  // namespace lambent::scenes
