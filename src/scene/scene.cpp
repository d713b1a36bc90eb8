// SPDX-License-Identifier: Apache-2.0
#include "lambent/scene.h"

#include <cmath>

namespace lambent {

Camera look_at(const glm::vec3& eye, const glm::vec3& target, float vertical_fov) {
  const glm::vec3 offset = eye - target;
  const float distance = glm::length(offset);
  const glm::vec3 back = distance > 0.0f ? offset / distance : glm::vec3(0.0f, 0.0f, 1.0f);
  // Use -Z in place of +Y when looking straight up or down
  constexpr float kParallel = 1.0f - 1e-6f;
  const glm::vec3 up =
      std::abs(back.y) < kParallel ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(0.0f, 0.0f, -1.0f);
  const glm::vec3 right = glm::normalize(glm::cross(up, back));

  Camera camera;
  camera.vertical_fov = vertical_fov;
  camera.world_from_view =
      glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f),
                glm::vec4(back, 0.0f), glm::vec4(eye, 1.0f));
  return camera;
}

Bounds instance_bounds(const Scene& scene, const Instance& instance) {
  Bounds bounds;
  for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
    bounds.add(glm::vec3(instance.world_from_object * glm::vec4(position, 1.0f)));
  }
  return bounds;
}

Bounds world_bounds(const Scene& scene) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    const Bounds own = instance_bounds(scene, instance);
    if (own.empty()) continue;
    bounds.add(own);
  }
  return bounds;
}

std::size_t triangle_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Instance& instance : scene.instances) {
    count += scene.meshes[instance.mesh].triangles.size();
  }
  return count;
}

}  // namespace lambent
