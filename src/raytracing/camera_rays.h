// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/scene.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// The ray through a point of the image, in pixels: (0, 0) is the top left corner, (0.5, 0.5) the
/// middle of the first pixel. Pixels are square; the vertical field of view (or extent) is the
/// camera's, whatever the image's shape.
Ray camera_ray(const Camera& camera, int width, int height, float x, float y);

/// Distance of a point from the camera's plane, along the axis of view [m].
float view_depth(const Camera& camera, const glm::vec3& position_ws);

}  // namespace lambent
