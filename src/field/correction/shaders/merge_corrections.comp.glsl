// SPDX-License-Identifier: Apache-2.0
// Adds listed samples to the table of corrections, one lane per bucket.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  MergeCorrectionsArguments args;
};

#define LearningRef MergeCorrectionsArguments

CorrectionKey fetch_key(MergeCorrectionsArguments table, uint slot) {
  return table.keys.at[slot];
}

void store_key(MergeCorrectionsArguments table, uint slot, CorrectionKey key) {
  table.keys.at[slot] = key;
}

LearnedCorrection fetch_learned(MergeCorrectionsArguments table, uint slot, int cell) {
  return table.learned.at[slot * uint(kCellCorners) + uint(cell)];
}

void store_learned(MergeCorrectionsArguments table, uint slot, int cell,
                   LearnedCorrection learned) {
  table.learned.at[slot * uint(kCellCorners) + uint(cell)] = learned;
}

CorrectionItem fetch_item(MergeCorrectionsArguments table, uint item) {
  return table.items.at[item];
}

#include "field/correction/learn.inl.h"

void main() {
  uint bucket = gl_GlobalInvocationID.y * kCorrectionRow + gl_GlobalInvocationID.x;
  // Where no lookup found light, there are no samples, and the table stays as it is
  if (bucket >= args.buckets || !(args.summary.at[kCorrectionMean] > 0.0)) return;
  merge_bucket(args, bucket * kCorrectionBucket, args.first_items.at[bucket], args.keep,
               args.summary.at[kCorrectionWorth]);
  args.first_items.at[bucket] = 0u;
}
