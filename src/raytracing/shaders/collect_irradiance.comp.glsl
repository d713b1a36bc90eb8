// SPDX-License-Identifier: Apache-2.0
// Sums up the direct irradiance that arrives at points, in the order of the slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/vulkan/shading_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CollectArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  vec3 sum = vec3(0.0f);
  for (uint slot = 0u; slot < args.slots; ++slot) {
    uint at = slot * args.count + i;
    if (args.dims_shadows != 0u) {
      sum += args.through.at[at] * args.unoccluded_irradiance.at[at];
    } else if (args.occluded.at[at] == 0u) {
      sum += args.unoccluded_irradiance.at[at];
    }
  }
  args.irradiance.at[args.first + i] = sum;
}
