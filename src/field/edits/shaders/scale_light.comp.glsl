// SPDX-License-Identifier: Apache-2.0
// Scales the light of probes by the ratio of direct light after an edit to that before it, and
// reduces their history ratios where it is of other sources.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"
#include "field/edits/history_ratio_math.h"
#include "field/probes/shaders/tiles.glsl"
#include "shared/color.h"

layout(local_size_x = kSumDirectLanes) in;
layout(push_constant, scalar) uniform Push {
  ScaleLightArguments args;
};

shared vec2 partial[kSumDirectLanes];  // luminance before, after

/// Luminance of a texel's direct light before and after the edit.
vec2 direct_at(int i) {
  return vec2(luminance(args.direct_before.at[i].xyz), luminance(args.direct_after.at[i].xyz));
}

/// Scales the light of the list's probe k, whose tile has so many texels.
void scale(int k, int tile) {
  vec2 all = vec2(args.direct_sums.at[0], args.direct_sums.at[1]);
  float brighter = all.x > 0.0 ? all.y / all.x : 1.0;
  vec2 own = vec2(0.0);
  for (int t = 0; t < tile; ++t) own += direct_at(k * tile + t);
  float probes = float(args.count);
  float share = history_share(own.x, own.y, all.x / probes, all.y / probes);
  args.history_shares.at[k] = share;
  for (int t = 0; t < tile; ++t) {
    args.light.at[args.list.at[k] * tile + t] *= brighter;
    int i = k * tile + t;
    args.history_ratio.at[i] = reduce_history_ratio(args.history_ratio.at[i], share);
  }
}

void main() {
  const int tile = kIrradianceTexels * kIrradianceTexels;
  int texels = args.count * tile;
  if (args.step == kScaleLight) {
    int k = int(gl_GlobalInvocationID.x);
    if (k < args.count) scale(k, tile);
    return;
  }
  int lane = int(gl_LocalInvocationIndex);
  vec2 sum = vec2(0.0);
  for (int i = lane; i < texels; i += kSumDirectLanes) sum += direct_at(i);
  partial[lane] = sum;
  barrier();
  if (lane != 0) return;
  for (int other = 1; other < kSumDirectLanes; ++other) sum += partial[other];
  args.direct_sums.at[0] = sum.x;
  args.direct_sums.at[1] = sum.y;
}
