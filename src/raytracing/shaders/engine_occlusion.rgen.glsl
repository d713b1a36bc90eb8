// SPDX-License-Identifier: Apache-2.0
// Whether each ray meets anything in an engine's acceleration structure, as engine_closest does.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/find_occlusion.glsl"

layout(push_constant, scalar) uniform Push {
  EngineTraceArguments args;
};

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  uint mask = ray.mask != 0u ? args.mask : 0u;
  args.occluded.at[i] = find_occlusion(args.structure, ray, gl_RayFlagsOpaqueEXT, mask);
}
