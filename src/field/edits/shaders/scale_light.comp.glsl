// SPDX-License-Identifier: Apache-2.0
// Scales the light of probes by the ratio of their direct light after an edit to that before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"
#include "field/probes/shaders/tiles.glsl"
#include "shared/color.h"

layout(local_size_x = kSumDirectLanes) in;
layout(push_constant, scalar) uniform Push {
  ScaleLightArguments args;
};

shared vec2 partial[kSumDirectLanes];  // luminance before, after

void main() {
  const int tile = kIrradianceTexels * kIrradianceTexels;
  int texels = args.count * tile;
  if (args.step == kScaleLight) {
    int i = int(gl_GlobalInvocationID.x);
    if (i < texels) args.light.at[args.list.at[i / tile] * tile + i % tile] *= args.brighter.at[0];
    return;
  }
  int lane = int(gl_LocalInvocationIndex);
  vec2 sum = vec2(0.0);
  for (int i = lane; i < texels; i += kSumDirectLanes) {
    sum += vec2(luminance(args.direct_before.at[i].xyz), luminance(args.direct_after.at[i].xyz));
  }
  partial[lane] = sum;
  barrier();
  if (lane != 0) return;
  for (int other = 1; other < kSumDirectLanes; ++other) sum += partial[other];
  args.brighter.at[0] = sum.x > 0.0 ? sum.y / sum.x : 1.0;
}
