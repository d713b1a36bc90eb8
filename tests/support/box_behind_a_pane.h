// SPDX-License-Identifier: Apache-2.0
// What pixels see through a blended surface.
#pragma once

#include "lambent/scene.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "support/hand_made.h"

namespace lambent::test {

/// The Cornell box behind a bright blended pane that covers little of it.
inline Scene box_behind_a_pane() {
  Scene scene = scenes::make("cornell").value();
  const Bounds box = world_bounds(scene);
  for (Material& wall : scene.materials) {
    wall.base_color = glm::vec4(0.4f * glm::vec3(wall.base_color), 1.0f);
    wall.lambert = false;
    wall.roughness = 0.4f;
  }
  Material pane;
  pane.base_color = glm::vec4(0.9f, 0.9f, 0.9f, 0.15f);
  pane.alpha_mode = AlphaMode::blend;
  pane.metallic = 0.0f;
  pane.roughness = 0.4f;
  pane.clearcoat = 0.8f;
  pane.clearcoat_roughness = 0.5f;
  pane.double_sided = true;
  scene.materials.push_back(pane);
  const glm::vec3 size = box.max - box.min;
  add(scene, quad({box.min.x, box.min.y, box.max.z - 0.05f * size.z}, {size.x, 0, 0},
                  {0, size.y, 0}, static_cast<int>(scene.materials.size()) - 1));
  scene.cameras.at(0).vertical_fov *= 0.7f;
  return scene;
}

}  // namespace lambent::test
