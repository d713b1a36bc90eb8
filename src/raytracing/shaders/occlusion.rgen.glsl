// SPDX-License-Identifier: Apache-2.0
// Finds whether each ray is occluded.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/find_occlusion.glsl"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  args.occluded.at[i] = find_occlusion(args.structure, ray, 0u, device_mask(ray.mask));
}
