// SPDX-License-Identifier: Apache-2.0
// Shifts the stored moments by the change in the moments of the probes' rays, one lane per texel.
// The stored moments average the rays of many updates; a shift preserves what did not change.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"
#include "field/probes/shaders/volume_of.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  MoveDistancesArguments args;
};

#include "field/probes/shaders/store_moments.glsl"

void main() {
  int t = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || t >= kDistanceTexels * kDistanceTexels) return;
  int probe = args.list.probes.at[k];
  RaySetRecord set = args.list.sets.at[args.list.ray_sets.at[k]];
  const int texels = kDistanceTexels * kDistanceTexels;
  const int columns = (texels + kDistanceBlock - 1) / kDistanceBlock * kDistanceBlock;

  // Blend the distances of the rays before the edit, and those after it
  vec2 before = vec2(0.0);
  vec2 now = vec2(0.0);
  float total = 0.0;
  for (int ray = 0; ray < set.rays; ++ray) {
    float weight = set.distance_weights.at[ray * columns + t];
    float distance_before = args.distances_before.at[k * args.stride + ray];
    float distance_now = args.distances.at[k * args.stride + ray];
    before += weight * vec2(distance_before, distance_before * distance_before);
    now += weight * vec2(distance_now, distance_now * distance_now);
    total += weight;
  }
  // A probe without history (kNoDistancesBefore) counts as blocked, and takes the new distances
  bool was_blocked = args.blocked_before.at[k] != 0u;
  bool is_blocked = args.blocked.at[k] != 0u;
  before = was_blocked ? vec2(0.0) : before / total;
  now = is_blocked ? vec2(0.0) : now / total;

  int width = kDistanceTexels + 2;
  int index = (probe * width + t / kDistanceTexels + 1) * width + t % kDistanceTexels + 1;
  float unit = distance_unit(args.store.grids.at[volume_of(args.store.grids, probe)]);
  vec2 held = moments_at(index) * vec2(unit, unit * unit);
  bool has_history = !was_blocked && !is_blocked;
  store_moments(index, shifted_moments(held, before, now, has_history), 1.0, 1.0 / unit);
}
