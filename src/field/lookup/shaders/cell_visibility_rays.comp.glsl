// SPDX-License-Identifier: Apache-2.0
// Makes the rays between the probes of cells, one lane per cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  CellVisibilityRaysArguments args;
};

#include "field/probes/shaders/store.glsl"
#include "field/probes/shaders/volume_of.glsl"
#include "field/lookup/visibility_math.h"
#include "field/lookup/visibility.inl.h"

void main() {
  int cell = int(gl_GlobalInvocationID.x);
  uint first = args.counter.at[kFirstItem], listed = args.counter.at[kCellsListed];
  uint among_all = first + uint(cell);
  if (cell >= args.count || among_all >= listed) return;
  if (cell == 0) {
    args.counter.at[kRaysRequested] = uint(kCellPairs) * min(uint(args.count), listed - first);
  }
  int lowest = args.cells.at[among_all];
  ProbeGrid grid = args.store.grids.at[volume_of(args.store.grids, lowest)];
  ivec3 coords = probe_coords(grid, lowest);
  vec3 places[kCellCorners];
  for (int k = 0; k < kCellCorners; ++k) places[k] = placed_probe(grid, coords + cell_corner(k));

  for (int pair = 0; pair < kCellPairs; ++pair) {
    ivec2 ends = cell_pair(pair);
    args.rays.at[cell * kCellPairs + pair] = visibility_ray(places[ends.x], places[ends.y]);
  }
}
