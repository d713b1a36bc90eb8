// SPDX-License-Identifier: Apache-2.0
// Finds the nearest hit of each ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/find_closest.glsl"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  args.hits.at[i] = find_closest(args.structure, ray, gl_RayFlagsNoneEXT, device_mask(ray.mask));
}
