// SPDX-License-Identifier: Apache-2.0
// Finds whether each ray is occluded.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/vulkan/trace_arguments.h"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};
layout(location = 0) rayPayloadEXT uint occluded;

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  occluded = 0u;
  uint mask = device_mask(ray.mask);
  if (mask != 0u && ray.t_min <= ray.t_max) {
    // A ray counts as occluded unless the miss shader runs, as no shader runs at hits
    occluded = 1u;
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
    traceRayEXT(accelerationStructureEXT(args.structure), flags, mask, 0, 0, 0, ray.origin_ws,
                ray.t_min, ray.direction_ws, min(ray.t_max, kFarthestOfDevices), 0);
  }
  args.occluded.at[i] = occluded;
}
