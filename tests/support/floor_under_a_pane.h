// SPDX-License-Identifier: Apache-2.0
// A coated floor whose lamp is behind clear glass.
#pragma once

#include "lambent/scene.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"

namespace lambent::test {

/// A metal floor that reflects a lamp through a pane between the two, and nothing else. All that
/// the camera sees is floor.
inline Scene floor_under_a_pane() {
  Scene scene;
  Material metal;
  metal.metallic = 1.0f;
  metal.roughness = 0.25f;
  Material glass;
  glass.metallic = 0.0f;
  glass.roughness = 0.0f;
  glass.transmission = 1.0f;
  scene.materials = {metal, glass};
  const int lamp = scenes::add_lambert(scene, "lamp", glm::vec3(0.0f), glm::vec3(4.0f));
  scenes::MeshBuilder builder;
  const auto add_square = [&](const char* name, int material, glm::vec3 middle, glm::vec2 half) {
    const glm::vec3 x(half.x, 0.0f, 0.0f), z(0.0f, 0.0f, half.y);
    builder.quad(middle - x + z, middle + x + z, middle + x - z, middle - x - z);
    scenes::add_object(scene, builder.take(name, material));
  };
  add_square("floor", 0, {0.0f, 0.0f, 0.0f}, {2.0f, 2.0f});
  add_square("pane", 1, {0.0f, 1.0f, 0.0f}, {3.0f, 3.0f});
  add_square("lamp", lamp, {0.0f, 1.6f, -0.5f}, {0.4f, 0.3f});
  scenes::add_camera(scene, "floor", {0.0f, 0.8f, 1.6f}, {0.0f, 0.0f, 0.4f}, 0.6f, 1.0f);
  return scene;
}

}  // namespace lambent::test
