// SPDX-License-Identifier: Apache-2.0
// Stores the last step of a solve, and computes the sums that the next step needs. The texels are
// divided among a fixed number of lanes, so that the sums are the same on every run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_solve.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  SolveSumsArguments args;
};

void main() {
  int lane = int(gl_GlobalInvocationID.x);
  if (lane >= kSumLanes) return;
  const int per_tile = kIrradianceTexels * kIrradianceTexels;
  int iteration = args.arrays.state.at[0].iterations;
  int steps = min(iteration, kAndersonDepth);
  int texels = args.arrays.state.at[0].texels;
  int newest = args.most_texels * ((iteration + kAndersonDepth - 1) % kAndersonDepth);
  Wide sums[kSolveSums];
  for (int s = 0; s < kSolveSums; ++s) sums[s] = make_wide(0.0);

  for (int i = lane; i < texels; i += kSumLanes) {
    vec4 image = args.arrays.image.at[i];
    sums[kImageSquare] = wide_add(sums[kImageSquare], make_wide(dot(image, image)));
    if (args.last != 0u) {
      int in_field = args.arrays.probes.at[i / per_tile] * per_tile + i % per_tile;
      vec4 change = args.arrays.field.at[in_field] - args.arrays.history.at[i];
      sums[kChangeSquare] = wide_add(sums[kChangeSquare], make_wide(dot(change, change)));
      continue;
    }
    vec4 residual = image - args.arrays.solution.at[i];
    sums[kResidualSquare] = wide_add(sums[kResidualSquare], make_wide(dot(residual, residual)));
    if (iteration > 0) {
      vec4 residual_change = residual - args.arrays.residual.at[i];
      vec4 image_change = image - args.arrays.previous_image.at[i];
      vec4 change = image_change - residual_change;
      args.arrays.residual_changes.at[newest + i] = residual_change;
      args.arrays.image_changes.at[newest + i] = image_change;
      sums[kChangeSquare] = wide_add(sums[kChangeSquare], make_wide(dot(change, change)));
      sums[kImageChangeSquare] =
          wide_add(sums[kImageChangeSquare], make_wide(dot(image_change, image_change)));
      for (int step = 0; step < steps; ++step) {
        vec4 other = args.arrays.residual_changes.at[step * args.most_texels + i];
        sums[kFirstGram + step] =
            wide_add(sums[kFirstGram + step], make_wide(dot(residual_change, other)));
        sums[kFirstProjection + step] =
            wide_add(sums[kFirstProjection + step], make_wide(dot(other, residual)));
      }
    }
    args.arrays.residual.at[i] = residual;
    args.arrays.previous_image.at[i] = image;
  }
  for (int s = 0; s < kSolveSums; ++s) args.sums.at[lane * kSolveSums + s] = sums[s];
}
