// SPDX-License-Identifier: Apache-2.0
// The nearest hit of each ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/trace_arguments.h"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};
layout(location = 0) rayPayloadEXT HitRecord hit;

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  hit = HitRecord(uintBitsToFloat(kMissedDistanceBits), 0u, 0u, vec2(0.0f), 0u);
  uint mask = device_mask(ray.mask);
  if (mask != 0u && ray.t_min <= ray.t_max) {
    traceRayEXT(accelerationStructureEXT(args.structure), gl_RayFlagsNoneEXT, mask, 0, 0, 0,
                ray.origin_ws, ray.t_min, ray.direction_ws, min(ray.t_max, kFarthestOfDevices), 0);
  }
  args.hits.at[i] = hit;
}
