// SPDX-License-Identifier: Apache-2.0
// Computes the irradiance at points whose lookups were found, one lane per point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  ReadLookupsArguments args;
};

#include "field/probes/shaders/store.glsl"

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= args.count) return;
  vec3 normal = args.queries.at[i].normal_ws;
  vec3 sum = vec3(0.0);
  for (int l = 0; l < kLookups; ++l) {
    SurfelLookup lookup = args.lookups.at[i * kLookups + l];
    if (lookup.tile_corner == kNoLookup) continue;
    ProbeGrid grid = args.store.grids.at[int(lookup.corners.table) / kCellWraps];
    ivec3 lowest = probe_coords(grid, lookup.corners.base);
    for (int k = 0; k < kCellCorners; ++k) {
      int probe = probe_index(grid, lowest + cell_corner(k));
      sum += fetch_irradiance(probe, normal) * lookup.corners.weight[k];
    }
  }
  args.irradiance.at[i] = sum;
}
