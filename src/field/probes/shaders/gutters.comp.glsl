// SPDX-License-Identifier: Apache-2.0
// Fills the gutters of tiles, one lane per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/probes/tile.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  GuttersArguments args;
};

void main() {
  int i = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || i >= gutter_texels(args.texels)) return;
  ivec2 at = gutter_texel(i, args.texels);
  ivec2 source = tile_source(at, args.texels) + ivec2(1);
  int width = args.texels + 2;
  int tile = args.probes.at[k] * width * width;
  int to = (tile + at.y * width + at.x) * args.words_per_texel;
  int from = (tile + source.y * width + source.x) * args.words_per_texel;
  for (int w = 0; w < args.words_per_texel; ++w) args.words.at[to + w] = args.words.at[from + w];
}
