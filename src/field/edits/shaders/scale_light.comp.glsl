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

shared vec3 partial[kSumLightLanes];  // sums of ProbeAtEdit

/// What the edit finds of the list's probe k, whose tile has so many texels.
ProbeAtEdit find_probe(int k, int tile) {
  float held = 0.0;
  for (int t = 0; t < tile; ++t) {
    held += luminance(args.light.at[args.list.at[k] * tile + t].xyz) / float(tile);
  }
  return probe_at_edit(args.edited.at[k], held);
}

/// Scales the light of the list's probe k, whose tile has so many texels.
void scale(int k, int tile) {
  vec3 all = args.mean.at[0];
  ProbeAtEdit mean = ProbeAtEdit(all.x, all.y, all.z);
  float brighter = direct_growth(mean.direct_before, mean.direct_after);
  float share = history_share(find_probe(k, tile), mean);
  args.history_shares.at[k] = share;
  for (int t = 0; t < tile; ++t) {
    args.light.at[args.list.at[k] * tile + t] *= brighter;
    int i = k * tile + t;
    args.history_ratio.at[i] = reduce_history_ratio(args.history_ratio.at[i], share);
  }
}

void main() {
  const int tile = kIrradianceTexels * kIrradianceTexels;
  if (args.step == kScaleLight) {
    int k = int(gl_GlobalInvocationID.x);
    if (k < args.count) scale(k, tile);
    return;
  }
  int lane = int(gl_LocalInvocationIndex);
  vec3 sum = vec3(0.0);
  for (int k = lane; k < args.count; k += kSumLightLanes) {
    ProbeAtEdit probe = find_probe(k, tile);
    sum += vec3(probe.held, probe.direct_before, probe.direct_after);
  }
  partial[lane] = sum;
  barrier();
  if (lane != 0) return;
  for (int other = 1; other < kSumLightLanes; ++other) sum += partial[other];
  args.mean.at[0] = sum / float(args.count);
}
