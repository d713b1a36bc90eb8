// SPDX-License-Identifier: Apache-2.0
// The nearest hit of each ray in an engine's acceleration structure, of which nothing is known but
// its address: masks are the engine's, and what is see-through stops rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "field/recorded_arguments.h"
#include "raytracing/trace_arguments.h"

layout(push_constant, scalar) uniform Push {
  EngineClosestArguments args;
};
layout(location = 0) rayPayloadEXT HitRecord hit;

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  hit = HitRecord(uintBitsToFloat(kMissedDistanceBits), 0u, 0u, vec2(0.0f), 0u);
  if (ray.mask != 0u) {
    traceRayEXT(accelerationStructureEXT(args.structure), gl_RayFlagsOpaqueEXT, ray.mask, 0, 0, 0,
                ray.origin_ws, ray.t_min, ray.direction_ws, kFarthestOfDevices, 0);
  }
  args.hits.at[i] = hit;
}
