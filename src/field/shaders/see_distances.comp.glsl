// SPDX-License-Identifier: Apache-2.0
// What hits count as in distances, and which probes stand in solid matter: a cluster a probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/blend_math.h"
#include "field/shaders/cluster.glsl"
#include "field/shaders/volume_of.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  SeeDistancesArguments args;
};

void main() {
  int k = int(gl_WorkGroupID.y * kGroupClusters + cluster_in_group());
  if (k >= args.probes) return;
  int rays = args.list.sets.at[args.list.ray_sets.at[k]].rays;
  int probe = args.list.probes.at[k];
  float farthest = max_probe_distance(args.grids.at[volume_of(args.grids, probe)]);
  int back_faces = 0;
  for (int ray = cluster_lane(); ray < args.stride; ray += kClusterLanes) {
    HitRecord hit = args.hits.at[k * args.stride + ray];
    uint back_face = 0u;
    if (ray < rays && !missed(hit) && hit.front_face == 0u) {
      back_face = args.single_sided.at[hit.instance];
    }
    back_faces += int(back_face);
    float counted = counted_distance(hit.distance, back_face, farthest);
    args.seen.at[k * args.stride + ray] = ray < rays ? counted : 0.0;
  }
  back_faces = cluster_sum(back_faces);
  if (cluster_lane() == 0) args.blocked.at[k] = stands_in_matter(back_faces, rays);
}
