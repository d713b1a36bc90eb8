// SPDX-License-Identifier: Apache-2.0
// Scales the light of probes by the ratio of direct light after an edit to that before it, and
// reduces their history ratios where it is of other sources.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"
#include "field/edits/history_ratio_math.h"
#include "field/probes/shaders/tiles.glsl"
#include "shared/color.h"

layout(local_size_x = kSumLightLanes) in;
layout(push_constant, scalar) uniform Push {
  ScaleLightArguments args;
};

shared vec3 partial[kSumLightLanes];  // as of `sums`

/// Luminance of texel i of the list's tiles: light that it holds, and direct light before and after
/// the edit.
vec3 light_at(int i, int tile) {
  int held = args.list.at[i / tile] * tile + i % tile;
  return vec3(luminance(args.light.at[held].xyz), luminance(args.direct_before.at[i].xyz),
              luminance(args.direct_after.at[i].xyz));
}

ProbeAtEdit probe_at_edit(vec3 sums) {
  return ProbeAtEdit(sums.x, sums.y, sums.z);
}

/// Scales the light of the list's probe k, whose tile has so many texels.
void scale(int k, int tile) {
  vec3 all = vec3(args.sums.at[0], args.sums.at[1], args.sums.at[2]);
  float brighter = direct_growth(all.y, all.z);
  vec3 own = vec3(0.0);
  for (int t = 0; t < tile; ++t) own += light_at(k * tile + t, tile);
  float share = history_share(probe_at_edit(own), probe_at_edit(all / float(args.count)));
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
  vec3 sum = vec3(0.0);
  for (int i = lane; i < texels; i += kSumLightLanes) sum += light_at(i, tile);
  partial[lane] = sum;
  barrier();
  if (lane != 0) return;
  for (int other = 1; other < kSumLightLanes; ++other) sum += partial[other];
  args.sums.at[0] = sum.x;
  args.sums.at[1] = sum.y;
  args.sums.at[2] = sum.z;
}
