// SPDX-License-Identifier: Apache-2.0
#include "bench/stage.h"

#include <algorithm>

#include "scenes/builtin.h"

namespace lambent::bench {
namespace {

bool has_light(const Scene& scene) {
  return !scene.lights.empty() || scene.environment.radiance != glm::vec3(0.0f) ||
         std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.emission != glm::vec3(0.0f); });
}

/// Adds a sun and a sky, as in the project's table of speeds.
void light_up(Scene& scene) {
  Light sun;
  sun.name = "sun";
  sun.type = Light::Type::directional;
  sun.intensity = {20.0f, 18.0f, 15.0f};
  sun.direction_ws = glm::normalize(glm::vec3(-0.62f, -0.8f, 0.10f));
  scene.lights.push_back(sun);
  scene.environment.radiance = {1.5f, 2.0f, 2.6f};
}

Camera camera_along(const Bounds& bounds) {
  constexpr float kEyeHeight = 0.15f, kDistance = 0.4f;  // shares of height and of length
  const glm::vec3 size = bounds.max - bounds.min;
  const glm::vec3 along = size.x >= size.z ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  glm::vec3 eye = 0.5f * (bounds.min + bounds.max) - kDistance * size * along;
  eye.y = bounds.min.y + kEyeHeight * size.y;
  return look_at(eye, eye + along, 1.0f);
}

}  // namespace

Scene open_stage(const std::string& name) {
  Scene scene = value_or_throw(scenes::open_scene(name));
  if (!has_light(scene)) light_up(scene);
  if (scene.cameras.empty()) scene.cameras.push_back(camera_along(world_bounds(scene)));
  return scene;
}

}  // namespace lambent::bench
