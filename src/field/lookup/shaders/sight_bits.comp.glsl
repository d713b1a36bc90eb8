// SPDX-License-Identifier: Apache-2.0
// Which probes of cells see each other, from the rays between them: a lane a cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/lookup/visibility_math.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  SightBitsArguments args;
};

void main() {
  int cell = int(gl_GlobalInvocationID.x);
  if (cell >= args.count) return;
  uint sights[2] = uint[2](0xFFFFFFFFu, 0xFFFFFFFFu);
  int ray = cell * kCellPairs;
  for (int i = 0; i < kCellCorners; ++i) {
    for (int k = i + 1; k < kCellCorners; ++k) {
      if (args.occluded.at[ray++] == 0u) continue;
      int bit = sight_bit(i, k), opposite = sight_bit(k, i);
      sights[bit >> 5] &= ~(1u << (bit & 31));
      sights[opposite >> 5] &= ~(1u << (opposite & 31));
    }
  }
  int lowest = args.cells.at[cell];
  args.sights.at[2 * lowest] = sights[0];
  args.sights.at[2 * lowest + 1] = sights[1];
}
