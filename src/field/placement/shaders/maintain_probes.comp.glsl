// SPDX-License-Identifier: Apache-2.0
// Sets the states and next places of probes from the hits of their rays. One workgroup per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/placement/classify_math.h"
#include "field/probes/shaders/volume_of.glsl"
#include "field/vulkan/recorded_arguments.h"

const int kLanes = 64;
layout(local_size_x = kLanes) in;
layout(push_constant, scalar) uniform Push {
  MaintainArguments args;
};

shared FixedRayHit fixed_hits[kMaxPlacementRays];
shared int by_height[kMaxPlacementRays];  // the hits whose planes pass below the probe
shared int hits_there;
shared int planes_there;
shared int back_faces;

int hit_count() {
  return hits_there;
}
FixedRayHit hit_at(int index) {
  return fixed_hits[index];
}
int plane_count() {
  return planes_there;
}
PlaneBelow plane_at(int rank) {
  return plane_below(fixed_hits[by_height[rank]]);
}
#include "field/placement/relocate.inl.h"

/// The hit of a ray, as relocation needs it.
FixedRayHit hit_of(int ray, int first, mat3 axes) {
  vec3 direction = args.rays.at[first + ray].direction_ws;
  RayResult result = args.results.at[first + ray];
  vec3 normal = result.kind == kRayLeft ? -direction : result.geometric_normal_ws;
  return FixedRayHit(direction * axes, result.kind == kRayLeft ? infinity() : result.distance,
                     normal * axes, result.kind == kRayMetBackFace ? 1u : 0u);
}

/// Sorts the hits whose planes pass below the probe by the probe's height over them.
void sort_planes(int lane) {
  for (int i = lane; i < hits_there; i += kLanes) {
    if (!passes_below(fixed_hits[i])) continue;
    float height = plane_below(fixed_hits[i]).height;
    int rank = 0;
    for (int j = 0; j < hits_there; ++j) {
      if (!passes_below(fixed_hits[j])) continue;
      float other = plane_below(fixed_hits[j]).height;
      if (other < height || (other == height && j < i)) ++rank;
    }
    by_height[rank] = i;
    atomicAdd(planes_there, 1);
  }
}

/// Takes a step of a probe's relocation. Sets the number of samples of a probe that moves to 0.
void place(int probe, ProbeGrid grid, uint inside_geometry) {
  RecordedProbe standing = args.probes.standing.at[probe];
  uint step = placing_step(standing.placed, args.placing_updates);
  if (step == kPlaceLeave) return;
  args.probes.standing.at[probe].placed = ++standing.placed;
  vec3 offset = decode_probe_offset(standing.offset);
  if (step == kPlaceFirstStep) standing.relocation = begin_relocation(offset);
  if (standing.relocation.converged != 0u) return;
  vec3 next = relocate(standing.relocation, offset, grid.spacing, inside_geometry,
                       is_odd_probe(grid, probe));
  if (step == kPlaceEnd) {
    next = standing.relocation.best;
    standing.relocation.converged = 1u;
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
  if (probe_is_skipped(args.probes.states.at[probe], args.probes.standing.at[probe].placed,
                  args.placing_updates, args.all)) {
    return;
  }
  ProbeGrid grid = args.grids.at[volume_of(args.grids, probe)];
  int first = k * args.rays_per_probe;
  int step = (args.rays_per_probe + kMaxPlacementRays - 1) / kMaxPlacementRays;
  if (lane == 0) {
    hits_there = (args.rays_per_probe + step - 1) / step;
    planes_there = back_faces = 0;
  }
  barrier();

  for (int i = lane; i < hits_there; i += kLanes) {
    fixed_hits[i] = hit_of(i * step, first, grid.axes);
  }
  for (int ray = lane; ray < args.rays_per_probe; ray += kLanes) {
    if (args.results.at[first + ray].kind == kRayMetBackFace) atomicAdd(back_faces, 1);
  }
  barrier();
  sort_planes(lane);
  barrier();
  if (lane != 0) return;
  uint inside_geometry = is_inside_geometry(back_faces, args.rays_per_probe);
  args.probes.states.at[probe] = inside_geometry != 0u ? kProbeOff : kProbeOn;
  place(probe, grid, inside_geometry);
}
