// SPDX-License-Identifier: Apache-2.0
// Adds samples to the linked lists of their blocks' buckets, one lane per sample. The order of a
// list differs from run to run, but the result does not depend on it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  CorrectionItemsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.y * kCorrectionRow + gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  CorrectionSampleRecord drawn = args.samples.at[i];
  float mean = args.summary.at[kCorrectionMean];
  if (!(mean > 0.0 && drawn.looked_up > 0.0)) return;
  ProbeGrid grid = args.grids.at[drawn.volume];
  CorrectionSum sum = correction_sum(drawn.gathered, drawn.looked_up, mean);
  uint axis = correction_axis(drawn.normal_ws * grid.axes, drawn.pick);
  vec3 coords = correction_coords(grid, drawn.position_ws);
  for (uint level = 0u; level < uint(kCorrectionLevels); ++level) {
    CorrectionItem item = correction_item(coords, axis, level, uint(drawn.volume), sum);
    uint bucket = correction_bucket(item.key, args.buckets) / kCorrectionBucket;
    uint place = i * uint(kCorrectionLevels) + level;
    item.next = atomicExchange(args.first_items.at[bucket], place + 1u);
    args.items.at[place] = item;
    coords *= 1.0 / kCorrectionGrowth;
  }
}
