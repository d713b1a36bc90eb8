// SPDX-License-Identifier: Apache-2.0
// A floor and its lamp, both behind glass.
#pragma once

#include <vector>

#include "lambent/scene.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"

namespace lambent::test {

/// A floor under a lamp, and a wall that keeps half of it in the shade. All that the camera sees is
/// glass of this roughness in front of them: a pane, or a slab of 20 cm.
inline Scene floor_behind_a_pane(const Material& floor, float roughness, bool slab = false) {
  Scene scene;
  Material glass;
  glass.metallic = 0.0f;
  glass.roughness = roughness;
  glass.transmission = 1.0f;
  glass.bounds_volume = slab;
  scene.materials = {floor, glass};
  const int lamp = scenes::add_lambert(scene, "lamp", glm::vec3(0.0f), glm::vec3(8.0f));
  scenes::MeshBuilder builder;
  const auto add_parallelogram = [&](const char* name, int material, glm::vec3 middle, glm::vec3 x,
                                     glm::vec3 y) {
    builder.quad(middle - x - y, middle + x - y, middle + x + y, middle - x + y);
    scenes::add_object(scene, builder.take(name, material));
  };
  const glm::vec3 x(1.0f, 0.0f, 0.0f), y(0.0f, 1.0f, 0.0f), z(0.0f, 0.0f, 1.0f);
  add_parallelogram("floor", 0, {0.0f, 0.0f, -1.0f}, 3.0f * x, -3.0f * z);
  add_parallelogram("wall", 0, {0.3f, 0.3f, -0.2f}, 0.4f * z, 0.3f * y);
  add_parallelogram("pane", 1, {0.0f, 1.0f, 1.2f}, 3.0f * x, 3.0f * y);
  if (slab) add_parallelogram("back", 1, {0.0f, 1.0f, 1.0f}, -3.0f * x, 3.0f * y);
  add_parallelogram("lamp", lamp, {-0.6f, 1.6f, -0.5f}, 0.4f * x, 0.3f * z);
  scenes::add_camera(scene, "floor", {0.0f, 0.8f, 1.6f}, {0.0f, 0.0f, -0.2f}, 0.6f, 1.0f);
  return scene;
}

/// Floors that have a base alone, a coat alone, and a clearcoat on both.
inline Material matte_floor() {
  Material floor;
  floor.lambert = true;
  floor.metallic = 0.0f;
  floor.base_color = glm::vec4(0.6f, 0.5f, 0.4f, 1.0f);
  return floor;
}
inline Material metal_floor() {
  Material floor;
  floor.metallic = 1.0f;
  floor.roughness = 0.4f;
  return floor;
}
inline Material lacquered_floor() {
  Material floor = matte_floor();
  floor.lambert = false;
  floor.roughness = 0.5f;
  floor.clearcoat = 1.0f;
  floor.clearcoat_roughness = 0.3f;
  return floor;
}
inline std::vector<Material> floors_to_show() {
  return {matte_floor(), metal_floor(), lacquered_floor()};
}

}  // namespace lambent::test
