// SPDX-License-Identifier: Apache-2.0
// Lists the cells that have one of a list's probes as a corner, one lane per probe of the list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/probes/shaders/volume_of.glsl"
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  CellsAroundArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.counter.at[kRowsListed]) return;
  int probe = args.probes.at[k];
  ProbeGrid grid = args.grids.at[volume_of(args.grids, probe)];
  ivec3 coords = probe_coords(grid, probe);
  for (int corner = 0; corner < kCellCorners; ++corner) {
    // The last probe of a row is not the lowest corner of any cell
    ivec3 base = coords - cell_corner(corner);
    if (base != clamp(base, ivec3(0), grid.count - ivec3(2))) continue;
    int lowest = probe_index(grid, base);
    if (atomicExchange(args.marks.at[lowest], 1u) != 0u) continue;
    args.cells.at[atomicAdd(args.counter.at[kCellsListed], 1u)] = lowest;
  }
}
