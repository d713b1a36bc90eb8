// SPDX-License-Identifier: Apache-2.0
// A room with many lights of all kinds at random places.
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "shared/random.h"
#include "shared/sampling.h"
#include "support/hand_made.h"

namespace lambent::test {

inline constexpr float kManyLightsRoom = 10.0f;  // edge [m]

/// A place in the room, off its walls.
inline glm::vec3 place_in_room(RandomStream& random) {
  const glm::vec2 xy = next_uniform2(random);
  const glm::vec3 u(xy, next_uniform(random));
  return (u - 0.5f) * (0.9f * kManyLightsRoom);
}

/// Emissive quads, point lights and spots, a third each, and a sun that stands outside the tree.
inline Scene many_lights(int of_each_kind) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f)),
                     lambert(glm::vec3(0.2f), glm::vec3(3.0f, 2.0f, 1.0f)),
                     lambert(glm::vec3(0.2f), glm::vec3(0.5f, 1.0f, 9.0f))};
  add_room(scene, kManyLightsRoom, 0);
  RandomStream random = make_random_stream(7u, 0u, 0u);
  for (int i = 0; i < of_each_kind; ++i) {
    const Frame frame = make_frame(sample_uniform_sphere(next_uniform2(random)));
    const float size = 0.05f + 0.5f * next_uniform(random);
    add(scene,
        quad(place_in_room(random), size * frame.tangent, size * frame.bitangent, 1 + i % 2));
    scene.lights.push_back(
        point_light(glm::vec3(1.0f + 4.0f * next_uniform(random)), place_in_room(random)));
    Light spot = point_light(glm::vec3(8.0f, 6.0f, 2.0f), place_in_room(random));
    spot.type = Light::Type::spot;
    spot.direction_ws = sample_uniform_sphere(next_uniform2(random));
    spot.outer_cone_angle = 0.2f + next_uniform(random);
    spot.inner_cone_angle = 0.5f * spot.outer_cone_angle;
    scene.lights.push_back(spot);
    if (i == 0) scene.lights.push_back(sun(glm::vec3(1.0f), {0.0f, -1.0f, 0.0f}));
  }
  return scene;
}

}  // namespace lambent::test
