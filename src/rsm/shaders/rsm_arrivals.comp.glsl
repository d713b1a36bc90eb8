// SPDX-License-Identifier: Apache-2.0
// Computes, for each pixel, the share of its rays to texels that are unoccluded.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/gather_pixel.glsl"

layout(push_constant, scalar) uniform Push {
  VisibilityArguments args;
};

void main() {
  Pixel pixel;
  ivec2 size = ivec2(args.width, args.height);
  if (!find_pixel(args.view, size, own_place(args.first_tile_row), pixel)) return;
  uint first = invocation_index() * uint(args.rays_per_pixel);
  uint occluded = 0u;
  for (int i = 0; i < args.rays_per_pixel; ++i) {
    occluded += args.occluded.at[first + uint(i)];
  }
  args.arrived.at[pixel.at.y * size.x + pixel.at.x] =
      1.0f - float(occluded) / float(args.rays_per_pixel);
}
