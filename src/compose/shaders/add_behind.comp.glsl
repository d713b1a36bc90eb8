// SPDX-License-Identifier: Apache-2.0
// Adds the filtered light of the first opaque surfaces behind glass to all transmitted light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/glossy/seen_through_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  AddBehindArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  vec3 light = args.seen.at[0].coat_albedo.at[i] * args.seen.at[0].filtered_coats.at[i];
  if (args.draws > 0u) {
    light += args.seen.at[0].emitter_albedo.at[i] * args.seen.at[0].filtered_emitters.at[i];
  }
  if (args.gathers != 0u && args.seen.at[0].depths.at[i] > 0.0f) {
    light += args.seen.at[0].gather.albedo.at[i] * args.seen.at[0].gather.filtered.at[i];
  }
  if (args.long_ways != 0u && args.seen.at[0].glass_depths.at[i] > 0.0f) {
    light += args.seen.at[0].filtered_long_ways.at[i];
  }
  args.seen.at[0].light.at[i] += light;
}
