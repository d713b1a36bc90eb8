// SPDX-License-Identifier: Apache-2.0
// A ball in light of radiance 1 from all around.
#pragma once

#include <cmath>
#include <vector>

#include "lambent/scene.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "shared/constants.h"

namespace lambent::test {

/// A ball of the material within black walls that shine, or under a sky: nothing else reflects.
inline Scene furnace_ball(const Material& material, bool sky) {
  Scene scene;
  scenes::MeshBuilder builder;
  if (sky) {
    scene.environment.radiance = glm::vec3(1.0f);
  } else {
    const int wall = scenes::add_lambert(scene, "wall", glm::vec3(0.0f), glm::vec3(1.0f));
    builder.room(glm::vec3(-3.0f), glm::vec3(3.0f));
    scenes::add_object(scene, builder.take("room", wall));
  }
  scene.materials.push_back(material);
  std::vector<glm::vec2> profile;
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = kPi * static_cast<float>(i) / kSteps;
    const bool pole = i == 0 || i == kSteps;
    profile.emplace_back(pole ? 0.0f : std::sin(angle), -std::cos(angle));
  }
  builder.lathe(glm::vec3(0.0f), profile, 2 * kSteps);
  scenes::add_object(scene, builder.take("ball", static_cast<int>(scene.materials.size()) - 1));
  scenes::add_camera(scene, "ball", {0.0f, 0.4f, 2.9f}, glm::vec3(0.0f), 0.9f, 1.0f);
  return scene;
}

}  // namespace lambent::test
