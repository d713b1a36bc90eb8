// SPDX-License-Identifier: Apache-2.0
// Stores which probes of cells see each other, from the rays between them. One lane per cell.
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
  if (cell >= args.count) return;
  uint cell_visibility[2] = uint[2](0xFFFFFFFFu, 0xFFFFFFFFu);
  int ray = cell * kCellPairs;
  for (int i = 0; i < kCellCorners; ++i) {
    for (int k = i + 1; k < kCellCorners; ++k) {
      if (args.occluded.at[ray++] == 0u) continue;
      int bit = visibility_bit(i, k), opposite = visibility_bit(k, i);
      cell_visibility[bit >> 5] &= ~(1u << (bit & 31));
      cell_visibility[opposite >> 5] &= ~(1u << (opposite & 31));
    }
  }
  int lowest = args.cells.at[cell];
  args.cell_visibility.at[2 * lowest] = cell_visibility[0];
  args.cell_visibility.at[2 * lowest + 1] = cell_visibility[1];
}
