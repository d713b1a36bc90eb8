// SPDX-License-Identifier: Apache-2.0
// The nearest hit of each ray in an engine's acceleration structure, of which nothing is known but
// its address: masks are the engine's, and what is see-through stops rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/recorded_arguments.h"
#include "raytracing/shaders/find_closest.glsl"

layout(push_constant, scalar) uniform Push {
  EngineClosestArguments args;
};

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  args.hits.at[i] = find_closest(args.structure, ray, gl_RayFlagsOpaqueEXT, ray.mask);
}
