// SPDX-License-Identifier: Apache-2.0
// Copies the tiles of some probes into the array of all probes' tiles, one lane per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  ScatterTilesArguments args;
};

void main() {
  int t = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  const int texels = kIrradianceTexels * kIrradianceTexels;
  if (k >= args.count || t >= texels) return;
  args.field.at[args.probes.at[k] * texels + t] = args.tiles.at[k * texels + t];
}
