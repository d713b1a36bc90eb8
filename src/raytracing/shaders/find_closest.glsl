// SPDX-License-Identifier: Apache-2.0
// The nearest hit of a ray, for ray generation shaders of closest hits.
#ifndef LAMBENT_RAYTRACING_SHADERS_FIND_CLOSEST_GLSL
#define LAMBENT_RAYTRACING_SHADERS_FIND_CLOSEST_GLSL
#extension GL_EXT_ray_tracing : require

#include "raytracing/vulkan/trace_arguments.h"

layout(location = 0) rayPayloadEXT HitRecord hit;

/// The ray is not traced, and misses, where the mask is 0. During traversal, until there is a hit,
/// front_face holds the ray's mask.
HitRecord find_closest(uvec2 structure, RayRecord ray, uint flags, uint mask) {
  hit = HitRecord(uintBitsToFloat(kMissedDistanceBits), 0u, 0u, vec2(0.0f),
                  ray.mask);
  if (mask != 0u && ray.t_min <= ray.t_max) {
    traceRayEXT(accelerationStructureEXT(structure), flags, mask, 0, 0, 0, ray.origin_ws, ray.t_min,
                ray.direction_ws, min(ray.t_max, kFarthestOfDevices), 0);
  }
  return hit;
}

#endif
