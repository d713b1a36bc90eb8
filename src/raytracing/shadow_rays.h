// SPDX-License-Identifier: Apache-2.0
// Shadow rays between two points, at least one of them on a surface.
#ifndef LAMBENT_RAYTRACING_SHADOW_RAYS_H
#define LAMBENT_RAYTRACING_SHADOW_RAYS_H

#include "raytracing/ray_records.h"
#include "shared/rays.h"

LAMBENT_BEGIN

/// A shadow ray ends short by this share of the offset of its origin, besides kShadowRayShortening:
/// that is many times the float error of a source about as far from the world's origin.
const float kRayEndShare = 0.25f;

/// The ray from a surface to a point of another one, which ends just short of it. The geometric
/// normal is on the side of the point. The direction is computed from the offset origin: between
/// surfaces that are close together and far from the world's origin, the offset is longer than what
/// the ray is shortened by.
LAMBENT_FN RayRecord ray_to_point(vec3 position_ws, vec3 geometric_normal_ws, vec3 point_ws,
                                  uint mask) {
  vec3 origin = offset_ray_origin(position_ws, geometric_normal_ws);
  vec3 way = point_ws - origin;
  float dist = length(way);
  vec3 direction = dist > 0.0f ? way / dist : vec3(0.0f, 0.0f, 1.0f);
  float end = dist * (1.0f - kShadowRayShortening) - kRayEndShare * length(origin - position_ws);
  RayRecord ray = {origin, 0.0f, direction, max(end, 0.0f), mask};
  return ray;
}

LAMBENT_END
#endif
