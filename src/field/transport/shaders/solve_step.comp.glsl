// SPDX-License-Identifier: Apache-2.0
// Decides whether a solve is done, and computes the coefficients of the next extrapolation. One
// workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_solve.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  SolveStepArguments args;
};

const int kLanes = 64;

shared Wide partial[kLanes][kSolveSums];

/// Adds the inner products of the newest step to the state, and estimates the error that is left.
void take_step(Wide sums[kSolveSums], inout SolveState state) {
  float bound = state.largest_blend_weight * state.max_albedo;
  float contraction = bound;
  if (state.iterations > 0) {
    int newest = (state.iterations - 1) % kAndersonDepth;
    state.steps = min(state.iterations, kAndersonDepth);
    for (int step = 0; step < state.steps; ++step) {
      state.products.gram[kAndersonDepth * newest + step] = sums[kFirstGram + step];
      state.products.gram[kAndersonDepth * step + newest] = sums[kFirstGram + step];
      state.products.projection[step] = sums[kFirstProjection + step];
    }
    float change = sqrt(sums[kChangeSquare].high);
    float image_change = sqrt(sums[kImageChangeSquare].high);
    if (change > 0.0) state.observed = max(state.observed, image_change / change);
    contraction = assumed_contraction(state.observed, bound);
  }
  ++state.iterations;
  float image_square = sums[kImageSquare].high;
  float relative_residual =
      image_square > 0.0 ? sqrt(sums[kResidualSquare].high / image_square) : 0.0;
  state.error = remaining_error(contraction, state.largest_blend_weight, relative_residual);
}

void main() {
  int lane = int(gl_LocalInvocationIndex);
  Wide sums[kSolveSums];
  for (int s = 0; s < kSolveSums; ++s) {
    sums[s] = make_wide(0.0);
    for (int i = lane; i < kSumLanes; i += kLanes) {
      sums[s] = wide_add(sums[s], args.sums.at[i * kSolveSums + s]);
    }
    partial[lane][s] = sums[s];
  }
  barrier();
  if (lane != 0) return;
  for (int other = 1; other < kLanes; ++other) {
    for (int s = 0; s < kSolveSums; ++s) sums[s] = wide_add(sums[s], partial[other][s]);
  }

  SolveState state = args.state.at[0];
  if (args.last != 0u) {
    float whole = sums[kImageSquare].high;
    args.state.at[0].change = whole > 0.0 ? sqrt(sums[kChangeSquare].high / whole) : 0.0;
    return;
  }
  take_step(sums, state);
  state.coefficients = step_coefficients(state.products, state.steps);
  if (state.error <= state.tolerance || state.iterations >= state.max_iterations) {
    GroupCounts none = GroupCounts(0u, 1u, 1u);
    state.over_texels = none;
    state.over_rays = none;
    state.over_blocks = none;
    state.over_sums = none;
    state.over_step = none;
  }
  args.state.at[0] = state;
}
