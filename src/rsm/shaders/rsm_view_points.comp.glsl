// SPDX-License-Identifier: Apache-2.0
// Finds the first pixels of a sequence that show a surface. One workgroup; each invocation tests a
// run of draws.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/vulkan/device_maps.h"

layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push {
  ViewPointsArguments args;
};

const uint kRun = kViewPointDraws / gl_WorkGroupSize.x;
shared int seen_before[gl_WorkGroupSize.x];

/// The pixel of a draw, or -1 where it shows nothing.
int seen_pixel(uint draw, vec2 shift) {
  ivec2 at = view_point_pixel(draw, shift, ivec2(args.width, args.height));
  int pixel = at.y * args.width + at.x;
  return args.view.normals_ws.at[pixel] == vec3(0.0f) ? -1 : pixel;
}

void main() {
  RandomStream random = make_random_stream(0u, kViewSalt, args.seed);
  vec2 shift = next_uniform2(random);
  uint first = gl_LocalInvocationIndex * kRun;
  int own = 0;
  for (uint i = 0u; i < kRun; ++i) own += seen_pixel(first + i, shift) >= 0 ? 1 : 0;

  // Count the pixels that earlier runs found
  seen_before[gl_LocalInvocationIndex] = own;
  barrier();
  int place = 0;
  for (uint i = 0u; i < gl_LocalInvocationIndex; ++i) place += seen_before[i];
  if (gl_LocalInvocationIndex + 1u == gl_WorkGroupSize.x) {
    int total = min(place + own, kViewPoints);
    args.count.at[0] = total;
    for (int i = total; i < kViewPoints; ++i) {
      args.points.at[i] = vec3(0.0f);
      args.points.at[kViewPoints + i] = vec3(0.0f);
    }
  }
  for (uint i = 0u; i < kRun && place < kViewPoints; ++i) {
    int pixel = seen_pixel(first + i, shift);
    if (pixel < 0) continue;
    args.points.at[place] = args.view.positions_ws.at[pixel];
    args.points.at[kViewPoints + place] = args.view.normals_ws.at[pixel];
    ++place;
  }
}
