// SPDX-License-Identifier: Apache-2.0
// Copies the light and the last estimates of the probes of a list out of the arrays of all probes,
// one lane per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  GatherTilesArguments args;
};

void main() {
  const int texels = kIrradianceTexels * kIrradianceTexels;
  int t = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || t >= texels) return;
  int in_field = args.probes.at[k] * texels + t;
  args.light_before.at[k * texels + t] = args.light.at[in_field];
  args.estimate.at[k * texels + t] = args.last_estimate.at[in_field];
}
