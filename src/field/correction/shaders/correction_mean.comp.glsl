// SPDX-License-Identifier: Apache-2.0
// Computes the mean lookup of an update's samples, and the number of samples that each counts as.
// One workgroup. The order of additions is fixed, so that sums are the same on every run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"

const uint kLanes = 256u;

layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push {
  CorrectionMeanArguments args;
};

// The sum over the samples of each lane.
shared vec2 sums[kLanes];

/// The sum over all lanes.
vec2 sum_of_lanes(uint lane, vec2 sum) {
  sums[lane] = sum;
  for (uint half_of = kLanes / 2u; half_of > 0u; half_of /= 2u) {
    barrier();
    if (lane < half_of) sums[lane] += sums[lane + half_of];
  }
  barrier();
  vec2 all = sums[0];
  barrier();
  return all;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  vec2 sum = vec2(0.0);
  for (uint i = lane; i < args.count; i += kLanes) {
    float looked_up = args.samples.at[i].looked_up;
    if (looked_up > 0.0) sum += vec2(looked_up, 1.0);
  }
  vec2 all = sum_of_lanes(lane, sum);
  float mean = all.y > 0.0 ? all.x / all.y : 0.0;

  sum = vec2(0.0);
  for (uint i = lane; i < args.count; i += kLanes) {
    CorrectionSampleRecord drawn = args.samples.at[i];
    if (!(drawn.looked_up > 0.0)) continue;
    CorrectionNoise noise =
        correction_noise(drawn.gathered, drawn.variance, drawn.looked_up, mean);
    sum += vec2(noise.variances, noise.squares);
  }
  all = sum_of_lanes(lane, sum);
  if (lane == 0u) {
    args.summary.at[kCorrectionMean] = mean;
    args.summary.at[kCorrectionWorth] = sample_weight(CorrectionNoise(all.x, all.y));
  }
}
