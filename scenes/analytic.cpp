// SPDX-License-Identifier: Apache-2.0
// Scenes with published closed forms or solved radiosity.
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "scenes/recipes.h"

namespace lambent::scenes {
namespace {

constexpr float kRightAngle = 1.5707963268f;  // [rad]

/// An orthographic camera half a metre above the unit square on y = 0 (corners 0 and 1), looking
/// down on exactly that square: +X is right, -Z is up. Surfaces that face or flank the square are
/// outside the picture.
Camera camera_on_unit_square() {
  Camera camera;
  camera.name = "receiver";
  camera.orthographic = true;
  camera.vertical_extent = 1.0f;
  camera.aspect = 1.0f;
  camera.world_from_view =
      glm::mat4(glm::vec4(1.0f, 0.0f, 0.0f, 0.0f), glm::vec4(0.0f, 0.0f, -1.0f, 0.0f),
                glm::vec4(0.0f, 1.0f, 0.0f, 0.0f), glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
  return camera;
}

/// A white unit square on the ground and a black one that emits radiance 1. The mean radiance that
/// the white square reflects is the form factor between the two.
AnimatedScene make_squares(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                           const glm::vec3& d) {
  Scene scene;
  const int white = add_lambert(scene, "receiver", glm::vec3(1.0f));
  const int lamp = add_lambert(scene, "emitter", glm::vec3(0.0f), glm::vec3(1.0f));
  MeshBuilder builder;
  builder.quad({0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f});
  add_object(scene, builder.take("receiver", white));
  builder.quad(a, b, c, d);
  add_object(scene, builder.take("emitter", lamp));
  scene.cameras.push_back(camera_on_unit_square());
  return {std::move(scene), {}};
}

}  // namespace

AnimatedScene make_squares_parallel() {
  return make_squares({0.0f, 1.0f, 0.0f}, {1.0f, 1.0f, 0.0f}, {1.0f, 1.0f, 1.0f},
                      {0.0f, 1.0f, 1.0f});
}

AnimatedScene make_squares_perpendicular() {
  return make_squares({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.0f},
                      {0.0f, 1.0f, 0.0f});
}

AnimatedScene make_cube() {
  constexpr float kHalfEdge = 5.0f;  // [m]
  constexpr float kReflectance = 2.0f / 3.0f;
  constexpr float kIntensity = 50000.0f;  // [W/sr]
  constexpr float kEyeToWall = 0.1f;      // [m]

  Scene scene;
  const int grey = add_lambert(scene, "grey", glm::vec3(kReflectance));
  MeshBuilder builder;
  builder.room(glm::vec3(-kHalfEdge), glm::vec3(kHalfEdge));
  add_object(scene, builder.take("room", grey));
  Light lamp;
  lamp.name = "centre";
  lamp.intensity = glm::vec3(kIntensity);
  scene.lights.push_back(lamp);
  // Views the opposite wall, which from the middle of the room would just fill a right angle.
  add_camera(scene, "wall", {0.0f, 0.0f, kHalfEdge - kEyeToWall}, {0.0f, 0.0f, -kHalfEdge},
             kRightAngle, 1.0f);
  return {std::move(scene), {}};
}

}  // namespace lambent::scenes
