// SPDX-License-Identifier: Apache-2.0
// A rough wall that the camera sees in a mirror alone.
#pragma once

#include "lambent/scene.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"

namespace lambent::test {

/// A room between a mirror and a rough wall, under a lamp. All that the camera sees is the wall in
/// the mirror, whose tint changes in the middle.
inline Scene wall_in_a_mirror(float mirror_roughness, float wall_metallic) {
  Scene scene;
  Material mirror;
  mirror.metallic = 1.0f;
  mirror.roughness = mirror_roughness;
  Material tinted = mirror;
  tinted.base_color = glm::vec4(0.4f, 0.6f, 0.9f, 1.0f);
  Material wall = mirror;
  wall.base_color = glm::vec4(0.9f, 0.7f, 0.5f, 1.0f);
  wall.metallic = wall_metallic;
  wall.roughness = 0.4f;
  scene.materials = {mirror, wall, tinted};
  const int red = scenes::add_lambert(scene, "red", glm::vec3(0.6f, 0.1f, 0.1f));
  const int white = scenes::add_lambert(scene, "white", glm::vec3(0.7f));
  const int lamp = scenes::add_lambert(scene, "lamp", glm::vec3(0.0f), glm::vec3(6.0f));
  scenes::MeshBuilder builder;
  const auto add_wall = [&](const char* name, int material, glm::vec3 corner, glm::vec3 along,
                            glm::vec3 up) {
    builder.quad(corner, corner + along, corner + along + up, corner + up);
    scenes::add_object(scene, builder.take(name, material));
  };
  const glm::vec3 x(4.0f, 0.0f, 0.0f), y(0.0f, 3.0f, 0.0f), z(0.0f, 0.0f, 4.0f);
  add_wall("mirror", 0, {-2.0f, 0.0f, -2.0f}, 0.6f * x, y);
  add_wall("tinted mirror", 2, {0.4f, 0.0f, -2.0f}, 0.4f * x, y);
  add_wall("wall", 1, {2.0f, 0.0f, 2.0f}, -x, y);
  add_wall("left", red, {-2.0f, 0.0f, 2.0f}, -z, y);
  add_wall("right", white, {2.0f, 0.0f, -2.0f}, z, y);
  add_wall("floor", white, {-2.0f, 0.0f, 2.0f}, x, -z);
  add_wall("ceiling", white, {-2.0f, 3.0f, -2.0f}, x, z);
  add_wall("lamp", lamp, {-0.5f, 2.9f, 0.0f}, 0.25f * x, 0.25f * z);
  scenes::add_camera(scene, "mirror", {0.6f, 1.4f, 0.5f}, {0.4f, 1.3f, -2.0f}, 0.3f, 1.0f);
  return scene;
}

}  // namespace lambent::test
