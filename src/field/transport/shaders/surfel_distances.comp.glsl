// SPDX-License-Identifier: Apache-2.0
// Computes the distances that rays count as (counted_distance()) from the probes' surfels, and
// which probes stand inside geometry. One lane group per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/placement/classify_math.h"
#include "field/probes/shaders/volume_of.glsl"
#include "field/transport/blend_math.h"
#include "field/transport/shaders/lane_group.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  SurfelDistancesArguments args;
};

void main() {
  int k = int(gl_WorkGroupID.x * kLaneGroupsPerWorkgroup + lane_group_in_workgroup());
  if (k >= args.count) return;
  int probe = args.list.probes.at[k];
  int rays = args.list.sets.at[args.list.ray_sets.at[k]].rays;
  ProbeGrid grid = args.store.grids.at[volume_of(args.store.grids, probe)];
  vec3 offset = decode_probe_offset(args.store.offsets.at[probe]);
  vec3 origin_ws = placed_position(grid, probe_coords(grid, probe), offset);
  float farthest = max_probe_distance(grid);
  int back_faces = 0;
  for (int ray = lane_in_group(); ray < args.distance_stride; ray += kLaneGroupSize) {
    float counted = 0.0;
    if (ray < rays) {
      SurfelRecord surfel = args.surfels.at[probe * args.stride + ray];
      uint back_face = surfel.kind == kSurfelSolidSide ? 1u : 0u;
      float seen =
          surfel.kind == kSurfelSky
              ? farthest
              : first_hit_distance(surfel.mirror_distance, length(surfel.position_ws - origin_ws));
      counted = counted_distance(seen, back_face, farthest);
      back_faces += int(back_face);
    }
    args.distances.at[k * args.distance_stride + ray] = counted;
  }
  back_faces = lane_group_sum(back_faces);
  if (lane_in_group() == 0) args.blocked.at[k] = is_inside_geometry(back_faces, rays);
}
