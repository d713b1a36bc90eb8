// SPDX-License-Identifier: Apache-2.0
// The nearest hit of a ray, for ray generation shaders of closest hits.
#ifndef LAMBENT_RAYTRACING_SHADERS_FIND_CLOSEST_GLSL
#define LAMBENT_RAYTRACING_SHADERS_FIND_CLOSEST_GLSL
#extension GL_EXT_ray_tracing : require

#include "raytracing/vulkan/trace_arguments.h"
#include "scene/coverage.h"

layout(location = 0) rayPayloadEXT ClosestPayload found;

/// The hit is left in `found`. The ray is not traced, and misses, where the mask is 0. `passed`:
/// see stops_ray().
void find_closest(uvec2 structure, RayRecord ray, uint flags, uint mask, float passed) {
  found =
      ClosestPayload(HitRecord(uintBitsToFloat(kMissedDistanceBits), 0u, 0u, vec2(0.0f), 0u, 1.0f),
                     ray.mask, passed, 0u, 0u, 1.0f);
  if (mask != 0u && ray.t_min <= ray.t_max) {
    traceRayEXT(accelerationStructureEXT(structure), flags, mask, 0, 0, 0, ray.origin_ws, ray.t_min,
                ray.direction_ws, min(ray.t_max, kFarthestOfDevices), 0);
  }
}

#endif
