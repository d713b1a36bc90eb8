// SPDX-License-Identifier: Apache-2.0
// The Cornell box under lights without extent of all kinds, as many as a test asks for.
#pragma once

#include <string>

#include "scenes/builtin.h"
#include "shared/random.h"
#include "support/hand_made.h"

namespace lambent::test {

/// A built-in scene of the Cornell box's size (5.5 m), with so many suns, points and spots in turn.
/// All of them reach some of what the camera sees, and all cast shadows.
inline Scene lit_box(const std::string& name, int lights) {
  Scene scene = scenes::make(name).value();
  scene.lights.clear();
  RandomStream random = make_random_stream(11u, 0u, 0u);
  for (int i = 0; i < lights; ++i) {
    const glm::vec2 xy = next_uniform2(random);
    const glm::vec3 place(0.5f + 4.5f * xy.x, 3.0f + 2.0f * xy.y,
                          0.5f + 4.5f * next_uniform(random));
    const glm::vec3 color(0.3f + next_uniform(random), 0.3f + next_uniform(random), 1.0f);
    if (i % 3 == 0) {
      // Through the open front
      const glm::vec3 way(xy.x - 0.5f, -0.2f - 0.4f * xy.y, 1.0f);
      scene.lights.push_back(sun(color, normalize(way)));
      continue;
    }
    Light light = point_light(4.0f * color, place);
    if (i % 3 == 2) {
      light.type = Light::Type::spot;
      light.direction_ws = normalize(glm::vec3(xy.x - 0.5f, -1.0f, 0.3f));
      light.outer_cone_angle = 0.6f + 0.4f * xy.y;
      light.inner_cone_angle = 0.5f * light.outer_cone_angle;
    }
    scene.lights.push_back(light);
  }
  return scene;
}

}  // namespace lambent::test
