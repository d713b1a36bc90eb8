// SPDX-License-Identifier: Apache-2.0
// Computes the values that lookups read from the cells of one level. Those of coarser levels must
// be computed already. One lane per cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  RefineCorrectionsArguments args;
};

#include "field/correction/shaders/corrections.glsl"

void main() {
  uint i = gl_GlobalInvocationID.y * kCorrectionRow + gl_GlobalInvocationID.x;
  if (i >= args.table.buckets * kCorrectionBucket * uint(kCellCorners)) return;
  CorrectionKey key = args.table.keys.at[i / uint(kCellCorners)];
  if (key.rest == 0u || level_of_key(key) != args.level) return;
  args.table.refined.at[i] =
      refined_cell(args.table, key, int(i) % kCellCorners, args.learned.at[i]);
}
