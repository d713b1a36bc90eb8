// SPDX-License-Identifier: Apache-2.0
// Whether a ray meets anything, for ray generation shaders of occlusion.
#ifndef LAMBENT_RAYTRACING_SHADERS_FIND_OCCLUSION_GLSL
#define LAMBENT_RAYTRACING_SHADERS_FIND_OCCLUSION_GLSL
#extension GL_EXT_ray_tracing : require

#include "raytracing/vulkan/trace_arguments.h"

layout(location = 0) rayPayloadEXT uint occluded;

/// 1: it does; 0: it does not. A mask of 0: the ray is not traced, and meets nothing.
uint find_occlusion(uvec2 structure, RayRecord ray, uint flags, uint mask) {
  occluded = 0u;
  if (mask != 0u && ray.t_min <= ray.t_max) {
    // Until a ray is known to have missed, it has met something: no shader runs at hits
    occluded = 1u;
    flags |= gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
    traceRayEXT(accelerationStructureEXT(structure), flags, mask, 0, 0, 0, ray.origin_ws, ray.t_min,
                ray.direction_ws, min(ray.t_max, kFarthestOfDevices), 0);
  }
  return occluded;
}

#endif
