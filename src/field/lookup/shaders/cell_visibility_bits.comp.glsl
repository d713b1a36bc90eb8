// SPDX-License-Identifier: Apache-2.0
// Stores which probes of cells are visible to each other, from the results of the rays between
// them. One lane per cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/lookup/visibility_math.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  CellVisibilityBitsArguments args;
};

void main() {
  int cell = int(gl_GlobalInvocationID.x);
  uint among_all = args.counter.at[kFirstItem] + uint(cell);
  if (cell >= args.count || among_all >= args.counter.at[kCellsListed]) return;
  uvec2 cell_visibility = all_visible();
  for (int pair = 0; pair < kCellPairs; ++pair) {
    if (args.occluded.at[cell * kCellPairs + pair] == 0u) continue;
    cell_visibility = without_pair(cell_visibility, cell_pair(pair));
  }
  int lowest = args.cells.at[among_all];
  args.cell_visibility.at[2 * lowest] = cell_visibility.x;
  args.cell_visibility.at[2 * lowest + 1] = cell_visibility.y;
}
