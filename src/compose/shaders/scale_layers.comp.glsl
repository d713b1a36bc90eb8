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
  PixelLayers layers = args.layers.at[pixel];
  layers.all *= args.scale;
  layers.direct *= args.scale;
  layers.indirect *= args.scale;
  layers.irradiance *= args.scale;
  layers.glossy *= args.scale;
  layers.transmission *= args.scale;
  layers.emission *= args.scale;
  layers.fog *= args.scale;
  layers.albedo *= args.scale;
  layers.normal *= args.scale;
  layers.position *= args.scale;
  layers.depth *= args.scale;
  args.layers.at[pixel] = layers;
}
