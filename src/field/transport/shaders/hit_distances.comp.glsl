// SPDX-License-Identifier: Apache-2.0
// Computes the distances that hits count as (counted_distance()), and which probes stand inside
// geometry. One lane group per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/placement/classify_math.h"
#include "field/transport/blend_math.h"
#include "field/transport/shaders/lane_group.glsl"
#include "field/probes/shaders/volume_of.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  HitDistancesArguments args;
};

void main() {
  int k = int(gl_WorkGroupID.x * kLaneGroupsPerWorkgroup + lane_group_in_workgroup());
  if (k >= args.count) return;
  int probe = args.probes.at[k];
  float farthest = max_probe_distance(args.grids.at[volume_of(args.grids, probe)]);
  int back_faces = 0;
  for (int ray = lane_in_group(); ray < args.distance_stride; ray += kLaneGroupSize) {
    float counted = 0.0;
    if (ray < args.rays_per_probe) {
      uint kind = args.surfels.at[probe * args.stride + ray].kind;
      uint back_face = kind == kSurfelSolidSide ? 1u : 0u;
      float seen = args.hits.at[k * args.rays_per_probe + ray].distance;
      counted = counted_distance(seen, back_face, farthest);
      back_faces += int(back_face);
    }
    args.distances.at[k * args.distance_stride + ray] = counted;
  }
  back_faces = lane_group_sum(back_faces);
  if (lane_in_group() == 0) {
    args.blocked.at[k] = is_inside_geometry(back_faces, args.rays_per_probe);
  }
}
