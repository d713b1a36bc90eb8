// SPDX-License-Identifier: Apache-2.0
// Finds the mean of what the lookups of an update's samples find, by one workgroup. Sums are made
// in one order, so that they are the same on every run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"

const uint kLanes = 256u;

layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push {
  CorrectionMeanArguments args;
};

// Sum and number of the samples of each lane.
shared vec2 sums[kLanes];

void main() {
  uint lane = gl_LocalInvocationIndex;
  vec2 sum = vec2(0.0);
  for (uint i = lane; i < args.count; i += kLanes) {
    float looked_up = args.samples.at[i].looked_up;
    if (looked_up > 0.0) sum += vec2(looked_up, 1.0);
  }
  sums[lane] = sum;
  for (uint half_of = kLanes / 2u; half_of > 0u; half_of /= 2u) {
    barrier();
    if (lane < half_of) sums[lane] += sums[lane + half_of];
  }
  if (lane == 0u) args.mean.at[0] = sums[0].y > 0.0 ? sums[0].x / sums[0].y : 0.0;
}
