// SPDX-License-Identifier: Apache-2.0
// Rays of a pinhole camera.
#ifndef LAMBENT_RAYTRACING_CAMERA_MATH_H
#define LAMBENT_RAYTRACING_CAMERA_MATH_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

/// A camera and its picture. Pixels are square; the vertical field of view (or extent) is the
/// camera's, whatever the picture's shape.
struct CameraRecord {
  mat3 axes;         ///< Columns: right, up, back.
  vec3 position_ws;  ///< [m]
  float half_view;   ///< Tangent of half the vertical field of view; orthographic: half the
                     ///< vertical extent [m].
  vec2 half_size;    ///< Half the picture's width and height [pixels].
  uint orthographic;
};

/// Where a ray comes from, and its way.
struct CameraRay {
  vec3 origin_ws;
  vec3 direction_ws;
};

/// The ray through a point of the picture, in pixels: (0, 0) is the top left corner, (0.5, 0.5) the
/// middle of the first pixel.
LAMBENT_FN CameraRay camera_ray(CameraRecord camera, vec2 pixel) {
  // Compute the point on the image plane, +Y up, whose half height is 1
  float plane_x = (pixel.x - camera.half_size.x) / camera.half_size.y;
  float plane_y = (camera.half_size.y - pixel.y) / camera.half_size.y;
  float across = plane_x * camera.half_view;
  float up = plane_y * camera.half_view;
  CameraRay ray;
  if (camera.orthographic != 0u) {
    ray.origin_ws = camera.position_ws + camera.axes * vec3(across, up, 0.0f);
    ray.direction_ws = normalize(-camera.axes[2]);
  } else {
    ray.origin_ws = camera.position_ws;
    ray.direction_ws = normalize(camera.axes * vec3(across, up, -1.0f));
  }
  return ray;
}

/// Distance of a point from the camera's plane, along the axis of view [m].
LAMBENT_FN float view_depth(CameraRecord camera, vec3 position_ws) {
  return -dot(position_ws - camera.position_ws, normalize(camera.axes[2]));
}

LAMBENT_END
#endif
