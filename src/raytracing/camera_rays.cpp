// SPDX-License-Identifier: Apache-2.0
#include "raytracing/camera_rays.h"

#include <cmath>

namespace lambent {

CameraRecord camera_record(const Camera& camera, int width, int height) {
  CameraRecord record;
  record.axes = glm::mat3(camera.world_from_view);
  record.position_ws = glm::vec3(camera.world_from_view[3]);
  record.half_view =
      camera.orthographic ? 0.5f * camera.vertical_extent : std::tan(0.5f * camera.vertical_fov);
  record.half_size = {0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height)};
  record.orthographic = camera.orthographic ? 1u : 0u;
  return record;
}

Ray camera_ray(const Camera& camera, int width, int height, float x, float y) {
  const CameraRay ray = camera_ray(camera_record(camera, width, height), vec2(x, y));
  return {ray.origin_ws, 0.0f, ray.direction_ws};
}

float view_depth(const Camera& camera, const glm::vec3& position_ws) {
  const CameraRecord record = camera_record(camera, 1, 1);
  return view_depth(record, position_ws);
}

}  // namespace lambent
