// SPDX-License-Identifier: Apache-2.0
// Averages the reciprocal distances to what the lobes of rough glass, and of coats behind glass,
// show.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/glossy/seen_through_records.h"
#include "glossy/glossy_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  SeenDistancesArguments args;
};

struct SeenDistances {
  FloatArray distances;
  ivec2 size;
};
#define CoatViewRef SeenDistances
float fetch_distance(SeenDistances view, ivec2 pixel) {
  return view.distances.at[pixel.y * view.size.x + pixel.x];
}
ivec2 view_size(SeenDistances view) {
  return view.size;
}

#include "glossy/seen_distance.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.width * args.height) return;
  ivec2 size = ivec2(args.width, args.height);
  ivec2 pixel = ivec2(i % args.width, i / args.width);
  FloatArray distances = args.seen.at[0].distances;
  FloatArray of_coats = args.seen.at[0].coat_distances;
  if (args.seen.at[0].lobes.at[i].sharpness > 0.0f) {
    args.seen.at[0].lobes.at[i].inverse_distance =
        seen_inverse_distance(SeenDistances(distances, size), pixel, 0u, 1u);
  }
  if (args.seen.at[0].coat_lobes.at[i].sharpness > 0.0f) {
    args.seen.at[0].coat_lobes.at[i].inverse_distance =
        seen_inverse_distance(SeenDistances(of_coats, size), pixel, 0u, 1u);
  }
}
