// SPDX-License-Identifier: Apache-2.0
// Gives probes whose light an edit did not change visibly their old light back, and lets the
// history of the others count less. One lane per probe.
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

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= args.count) return;
  const int texels = kIrradianceTexels * kIrradianceTexels;
  int probe = args.list.at[k];
  int first = probe * texels;
  float squares = 0.0;
  float before = 0.0;
  float now = 0.0;
  for (int t = 0; t < texels; ++t) {
    vec3 held = args.light_before.at[k * texels + t].xyz;
    vec3 holds = args.light.at[first + t].xyz;
    float difference = luminance(holds - held);
    squares += difference * difference;
    before += luminance(held);
    now += luminance(holds);
  }
  before /= float(texels);
  now /= float(texels);

  // The last estimate stays as well, so that several changes too small to be seen add up
  bool changed =
      mean_relative_square(squares, texels, before) >= kChangedFraction * kChangedFraction;
  args.changed.at[k] = changed ? 1u : 0u;
  args.probes.standing.at[probe].coarse = 0u;
  LikenessSums sums = LikenessSums(0.0, 0.0);
  for (int t = 0; t < texels; ++t) {
    int own = k * texels + t;
    vec4 held = args.light_before.at[own];
    if (!changed) {
      args.light.at[first + t] = held;
      continue;
    }
    sums = add_likeness(sums, args.light.at[first + t].xyz, now, held.xyz, before);
    args.last_estimate.at[first + t] = args.solution.at[own] / args.history_ratio.at[own];
  }
  if (!changed) return;
  float kept = likeness_of(sums, now, before);
  float samples = args.probes.standing.at[probe].samples;
  args.probes.standing.at[probe].samples = samples_after_edit(samples, kept);
}
