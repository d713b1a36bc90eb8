// SPDX-License-Identifier: Apache-2.0
// What probes are for, and where they are to stand, from what their rays saw: a workgroup a probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/recorded_arguments.h"
#include "field/probes/shaders/volume_of.glsl"

const int kLanes = 64;
layout(local_size_x = kLanes) in;
layout(push_constant, scalar) uniform Push {
  MaintainArguments args;
};

shared Sight sights[kMostSights];
shared int by_height[kMostSights];  // those that pass below
shared int sights_there;
shared int planes_there;
shared int back_faces;

int sight_count() { return sights_there; }
Sight sight_at(int index) { return sights[index]; }
int plane_count() { return planes_there; }
PlaneBelow plane_at(int rank) { return plane_below(sights[by_height[rank]]); }
#include "field/placement/relocate.inl.h"

/// What a ray saw.
Sight sight_of(int ray, int first, mat3 axes) {
  vec3 direction = args.rays.at[first + ray].direction_ws;
  RayResult told = args.results.at[first + ray];
  vec3 normal = told.kind == kRayLeft ? -direction : told.geometric_normal_ws;
  return Sight(direction * axes, told.kind == kRayLeft ? infinity() : told.distance, normal * axes,
               told.kind == kRayMetBackFace ? 1u : 0u);
}

/// Puts the sights that pass below in order.
void sort_planes(int lane) {
  for (int i = lane; i < sights_there; i += kLanes) {
    if (!passes_below(sights[i])) continue;
    float height = plane_below(sights[i]).height;
    int rank = 0;
    for (int j = 0; j < sights_there; ++j) {
      if (!passes_below(sights[j])) continue;
      float other = plane_below(sights[j]).height;
      if (other < height || (other == height && j < i)) ++rank;
    }
    by_height[rank] = i;
    atomicAdd(planes_there, 1);
  }
}

/// Where a probe is to stand next; from another place it averages anew.
void place(int probe, vec3 spacing, uint in_solid_matter) {
  ProbeStanding standing = args.probes.standing.at[probe];
  vec3 offset = decode_probe_offset(standing.offset);
  if (args.place == kPlaceFirstStep) standing.walk = begin_walk(offset);
  if (standing.walk.at_rest != 0u) return;
  vec3 position = offset * spacing;
  vec3 better = better_place(position, vec3(0.0), spacing, in_solid_matter);
  float margin = kSurfaceMargin * min(spacing.x, min(spacing.y, spacing.z));
  float unrest = probe_unrest(position, better, margin, in_solid_matter);
  vec3 there = better == position ? offset : better / spacing;
  vec3 next = step_walk(standing.walk, offset, there, unrest);
  if (args.place == kPlaceEnd) {
    next = standing.walk.best;
    standing.walk.at_rest = 1u;
  }
  uint word = encode_probe_offset(next);
  if (word != standing.offset) standing.samples = 0.0;
  standing.offset = word;
  args.probes.standing.at[probe] = standing;
}

void main() {
  int k = int(gl_WorkGroupID.x);
  int lane = int(gl_LocalInvocationIndex);
  int probe = args.list.at[k];
  if (probe_rests(args.probes.states.at[probe], args.all)) return;
  ProbeGrid grid = args.grids.at[volume_of(args.grids, probe)];
  int first = k * args.rays_per_probe;
  int step = (args.rays_per_probe + kMostSights - 1) / kMostSights;
  if (lane == 0) {
    sights_there = (args.rays_per_probe + step - 1) / step;
    planes_there = back_faces = 0;
  }
  barrier();

  for (int i = lane; i < sights_there; i += kLanes) {
    sights[i] = sight_of(i * step, first, grid.axes);
  }
  for (int ray = lane; ray < args.rays_per_probe; ray += kLanes) {
    if (args.results.at[first + ray].kind == kRayMetBackFace) atomicAdd(back_faces, 1);
  }
  barrier();
  sort_planes(lane);
  barrier();
  if (lane != 0) return;
  uint in_solid_matter = stands_in_matter(back_faces, args.rays_per_probe);
  args.probes.states.at[probe] = in_solid_matter != 0u ? kProbeOff : kProbeOn;
  if (args.place != kPlaceLeave) place(probe, grid.spacing, in_solid_matter);
}
