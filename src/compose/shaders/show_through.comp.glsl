// SPDX-License-Identifier: Apache-2.0
// Adds filtered transmitted light to the layers of the pixels that are shown.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/glossy/seen_through_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ShowThroughArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint i = args.first + k;
  vec3 transmitted =
      args.share * args.seen.at[0].albedo.at[i] * args.seen.at[0].filtered.at[i];
  args.layers.at[k].transmission += transmitted;
  args.layers.at[k].all += transmitted;
}
