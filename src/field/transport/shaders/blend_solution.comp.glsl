// SPDX-License-Identifier: Apache-2.0
// Blends the solution of a solve into the field, one lane per texel. What exactly is blended
// depends on the step of the solve (kBeginSolve and others).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_solve.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  BlendSolutionArguments args;
};

void main() {
  const int texels = kIrradianceTexels * kIrradianceTexels;
  int t = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.probes || t >= texels) return;
  int own = k * texels + t;
  int in_field = args.arrays.probes.at[k] * texels + t;
  float blend_weight = args.arrays.blend_weights.at[k];

  if (args.step == kBeginSolve) {
    vec4 history = args.arrays.field.at[in_field];
    args.arrays.history.at[own] = history;
    args.arrays.solution.at[own] = history;
    args.arrays.field.at[in_field] = mix(history, history, blend_weight);
    return;
  }
  vec4 image = args.arrays.image.at[own];
  if (args.step == kPlainSolution) {
    args.arrays.field.at[in_field] = image;
    return;
  }
  vec4 history = args.arrays.history.at[own];
  if (args.step == kEndSolve) {
    args.arrays.field.at[in_field] = max(mix(history, image, blend_weight), vec4(0.0));
    return;
  }

  // Extrapolate from the last steps; without them, the next iterate is the image
  int steps = args.arrays.state.at[0].steps;
  vec4 next = image;
  for (int step = 0; step < steps; ++step) {
    next -= args.arrays.state.at[0].coefficients[step] *
            args.arrays.image_changes.at[step * args.probes * texels + own];
  }
  args.arrays.solution.at[own] = next;
  args.arrays.field.at[in_field] = mix(history, next, blend_weight);
}
