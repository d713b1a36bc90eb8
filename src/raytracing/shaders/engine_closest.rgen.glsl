// SPDX-License-Identifier: Apache-2.0
// Finds the closest hit of each ray in an engine's acceleration structure. Only the structure's
// address is known: instance masks are the engine's, and transparent surfaces stop rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/find_closest.glsl"

layout(push_constant, scalar) uniform Push {
  EngineTraceArguments args;
};

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  find_closest(args.structure, ray, gl_RayFlagsOpaqueEXT, ray.mask, kNothingPassed);
  args.hits.at[i] = found.hit;
}
