// SPDX-License-Identifier: Apache-2.0
#include "raytracing/camera_rays.h"

#include <cmath>

namespace lambent {

Ray camera_ray(const Camera& camera, int width, int height, float x, float y) {
  // Compute the point on the image plane, +Y up, whose half height is 1
  const float half_height = 0.5f * static_cast<float>(height);
  const float plane_x = (x - 0.5f * static_cast<float>(width)) / half_height;
  const float plane_y = (half_height - y) / half_height;

  const glm::mat3 axes(camera.world_from_view);
  Ray ray;
  ray.origin = glm::vec3(camera.world_from_view[3]);
  if (camera.orthographic) {
    const float half_extent = 0.5f * camera.vertical_extent;
    ray.origin += axes * glm::vec3(plane_x * half_extent, plane_y * half_extent, 0.0f);
    ray.direction = glm::normalize(-axes[2]);
    return ray;
  }
  const float slope = std::tan(0.5f * camera.vertical_fov);
  ray.direction = glm::normalize(axes * glm::vec3(plane_x * slope, plane_y * slope, -1.0f));
  return ray;
}

float view_depth(const Camera& camera, const glm::vec3& position_ws) {
  const glm::vec3 offset = position_ws - glm::vec3(camera.world_from_view[3]);
  return -glm::dot(offset, glm::normalize(glm::vec3(camera.world_from_view[2])));
}

}  // namespace lambent
