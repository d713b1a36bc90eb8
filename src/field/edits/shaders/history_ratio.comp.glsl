// SPDX-License-Identifier: Apache-2.0
// Computes the history ratios of probes that are traced again, one lane per texel. Probes without
// history get a ratio of 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"
#include "field/edits/history_ratio_math.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  HistoryRatioArguments args;
};

void main() {
  const int texels = kIrradianceTexels * kIrradianceTexels;
  int t = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || t >= texels) return;
  int probe = args.list.at[k];
  int own = k * texels + t;
  bool known = has_history(args.probes.states.at[probe], args.probes.standing.at[probe].samples);
  if (!known) {
    args.history_ratio.at[own] = vec4(1.0);
    if (t == 0) args.blocked_before.at[k] = kNoDistancesBefore;
    return;
  }
  if (args.probes.standing.at[probe].coarse != 0u) {
    args.last_estimate.at[probe * texels + t] = args.estimate.at[own];
  }
  args.history_ratio.at[own] = history_ratio_between(args.last_estimate.at[probe * texels + t],
                                                     args.light_before.at[own]);
}
