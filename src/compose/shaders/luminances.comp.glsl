// SPDX-License-Identifier: Apache-2.0
// Computes the luminances of a picture's pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"
#include "shared/color.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  LuminancesArguments args;
};

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  if (pixel >= args.count) return;
  args.luminances.at[pixel] = luminance(args.layers.at[pixel].all);
}
