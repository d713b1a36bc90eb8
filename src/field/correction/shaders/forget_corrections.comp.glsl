// SPDX-License-Identifier: Apache-2.0
// Reduces the weights of the samples of cells where edits changed light, one lane per block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  ForgetCorrectionsArguments args;
};

void main() {
  uint slot = gl_GlobalInvocationID.y * kCorrectionRow + gl_GlobalInvocationID.x;
  if (slot >= args.slots) return;
  CorrectionKey key = args.keys.at[slot];
  if (key.rest == 0u) return;
  ProbeGrid grid = args.grids.at[volume_of_key(key)];
  ProbeCell cell = probe_cell(grid, block_centre(grid, key));
  float least = 1.0;
  for (int k = 0; k < kCellCorners; ++k) {
    least = min(least, args.kept.at[probe_index(grid, cell.base + cell_corner(k))]);
  }
  if (least >= 1.0) return;
  for (int k = 0; k < kCellCorners; ++k) {
    uint at = slot * uint(kCellCorners) + uint(k);
    args.learned.at[at] =
        updated_correction(args.learned.at[at], least, CorrectionSum(0u, 0u), 0.0);
  }
}
