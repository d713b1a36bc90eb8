// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/scene.h"
#include "raytracing/camera_math.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// A camera with a picture of this size [pixels].
CameraRecord camera_record(const Camera& camera, int width, int height);

/// The ray through a point of the image, in pixels; see camera_math.h.
Ray camera_ray(const Camera& camera, int width, int height, float x, float y);

/// Distance of a point from the camera's plane, along the axis of view [m].
float view_depth(const Camera& camera, const glm::vec3& position_ws);

}  // namespace lambent
