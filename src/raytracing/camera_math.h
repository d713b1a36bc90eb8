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

/// Origin and direction of a ray of the camera.
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

/// The image of a point.
struct ImagePoint {
  vec2 pixel;   ///< See camera_ray().
  float depth;  ///< From the camera's plane [m]; not above 0: the point is behind the camera.
};

/// Components of a vector along the camera's axes, which need not be orthogonal.
LAMBENT_FN vec3 along_axes(CameraRecord camera, vec3 vector_ws) {
  vec3 across_right = cross(camera.axes[1], camera.axes[2]);
  vec3 across_up = cross(camera.axes[2], camera.axes[0]);
  vec3 across_back = cross(camera.axes[0], camera.axes[1]);
  return vec3(dot(vector_ws, across_right), dot(vector_ws, across_up),
              dot(vector_ws, across_back)) /
         dot(camera.axes[0], across_right);
}

/// The point of the picture for a point of the image plane whose half height is 1, +Y up.
LAMBENT_FN vec2 pixel_of_plane(CameraRecord camera, vec2 plane) {
  return camera.half_size + camera.half_size.y * vec2(plane.x, -plane.y);
}

/// The image of a point: the inverse of camera_ray().
LAMBENT_FN ImagePoint image_point(CameraRecord camera, vec3 position_ws) {
  vec3 view = along_axes(camera, position_ws - camera.position_ws);
  float divisor = camera.half_view * (camera.orthographic != 0u ? 1.0f : -view.z);
  ImagePoint point = {pixel_of_plane(camera, vec2(view.x, view.y) / divisor), -view.z};
  return point;
}

/// The image of an infinitely distant point in a direction. An orthographic camera sees one
/// direction in all its pixels, which the middle stands for.
LAMBENT_FN ImagePoint image_point_of_sky(CameraRecord camera, vec3 direction_ws) {
  if (camera.orthographic != 0u) {
    ImagePoint middle = {camera.half_size, infinity()};
    return middle;
  }
  vec3 view = along_axes(camera, direction_ws);
  ImagePoint point = {pixel_of_plane(camera, vec2(view.x, view.y) / (-view.z * camera.half_view)),
                      view.z < 0.0f ? infinity() : 0.0f};
  return point;
}

/// Distance of a point from the camera's plane, along the axis of view [m].
LAMBENT_FN float view_depth(CameraRecord camera, vec3 position_ws) {
  return -dot(position_ws - camera.position_ws, normalize(camera.axes[2]));
}

/// Width of a pixel at a depth [m].
LAMBENT_FN float pixel_width_at_depth(CameraRecord camera, float depth) {
  float at_unit = camera.half_view / camera.half_size.y;
  return camera.orthographic != 0u ? at_unit : at_unit * depth;
}

/// Width of a pixel at a point that the camera sees [m].
LAMBENT_FN float pixel_width(CameraRecord camera, vec3 position_ws) {
  return pixel_width_at_depth(camera, view_depth(camera, position_ws));
}

LAMBENT_END
#endif
