// SPDX-License-Identifier: Apache-2.0
// Restores the light of probes that an edit did not change visibly, and reduces the numbers of
// samples of the others. One lane per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"
#include "field/edits/history_ratio_math.h"
#include "field/probes/shaders/tiles.glsl"
#include "shared/color.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  KeepUnchangedArguments args;
};

int own, in_field;  // the first texel of the probe's tile in the list and in the field

vec3 fetch_before(int texel) {
  return args.light_before.at[own + texel].xyz;
}
vec3 fetch_now(int texel) {
  return args.light.at[in_field + texel].xyz;
}
#include "field/probes/tile_light.inl.h"

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= args.count) return;
  const int texels = kIrradianceTexels * kIrradianceTexels;
  int probe = args.list.at[k];
  own = k * texels;
  in_field = probe * texels;
  LightChange change = light_change(texels);

  // The last estimate stays as well, so that several changes too small to be visible add up
  bool changed = mean_relative_square(change.squares, texels, change.before) >=
                 kChangedFraction * kChangedFraction;
  args.changed.at[k] = changed ? 1u : 0u;
  args.probes.standing.at[probe].coarse = 0u;
  float samples = args.probes.standing.at[probe].samples;
  EstimateVariance variance = estimate_variance(args.edited.at[k], change.before, change.now);
  LikenessSums sums = LikenessSums(0.0, 0.0);
  for (int t = 0; t < texels; ++t) {
    if (!changed) {
      args.light.at[in_field + t] = args.light_before.at[own + t];
      continue;
    }
    sums = add_likeness(sums, fetch_now(t), change.now, fetch_before(t), change.before);
    args.last_estimate.at[in_field + t] =
        args.solution.at[own + t] / args.history_ratio.at[own + t];
  }
  if (changed) {
    float kept = likeness_of(sums, change.now, change.before) * args.history_shares.at[k];
    samples = samples_after_edit(samples, variance, kept);
  } else {
    samples = samples_after_ratio(samples, variance);
  }
  args.probes.standing.at[probe].samples = samples;
}
