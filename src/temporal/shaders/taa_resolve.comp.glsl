// SPDX-License-Identifier: Apache-2.0
// Temporal anti-aliasing: blends each pixel of a frame with its history.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "temporal/taa_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  TaaArguments args;
};

// What taa_resolve.inl.h requires of its includer; all data is in the arguments.
#define TaaPictureRef uint
#define TaaHistoryRef uint

uint index_of(ivec2 pixel) {
  return uint(pixel.y * args.frame.width + pixel.x);
}
vec3 fetch_radiance(uint picture, ivec2 pixel) {
  uint i = index_of(pixel) * args.stride;
  return vec3(args.picture.at[i], args.picture.at[i + 1u], args.picture.at[i + 2u]);
}
PixelMotion fetch_motion(uint picture, ivec2 pixel) {
  return args.motion.at[index_of(pixel)];
}
TaaPixel fetch_history(uint history, ivec2 pixel) {
  return args.history.at[index_of(pixel)];
}

#include "temporal/taa_resolve.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(args.frame.width * args.frame.height)) return;
  ivec2 pixel = ivec2(int(i) % args.frame.width, int(i) / args.frame.width);
  args.result.at[i] = resolve_taa(args.frame, 0u, 0u, pixel);
}
