// SPDX-License-Identifier: Apache-2.0
// Makes surfels from shaded hits, one lane per surfel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  MakeSurfelsArguments args;
};

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || ray >= args.rays_per_probe) return;
  int i = k * args.rays_per_probe + ray;
  LitPointRecord point = args.points.at[i];
  args.surfels.at[args.probes.at[k] * args.stride + ray] =
      surfel_record(point.position_ws, point.normal_ws, point.geometric_normal_ws,
                    args.shaded.at[i], args.irradiance.at[i]);
}
