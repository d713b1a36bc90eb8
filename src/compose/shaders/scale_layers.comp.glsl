// SPDX-License-Identifier: Apache-2.0
// Multiplies the layers of the pixels that take further samples.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ScaleLayersArguments args;
};

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  if (pixel >= args.count || args.skipped.at[pixel] != 0u) return;
  args.layers.at[pixel] = scaled_layers(args.layers.at[pixel], args.scale);
}
