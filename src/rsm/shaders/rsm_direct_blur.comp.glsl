// SPDX-License-Identifier: Apache-2.0
// Sums up arriving and unoccluded light around a pixel, first along rows, then along columns, and
// scales the pixel's light by their ratio.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/vulkan/device_direct.h"

layout(local_size_x = 32, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  DirectBlurArguments args;
};

vec3 fetch_position(int pixel) {
  return args.view.positions_ws.at[pixel];
}
vec3 fetch_normal(int pixel) {
  return args.view.normals_ws.at[pixel];
}
float fetch_depth(int pixel) {
  return args.view.depths.at[pixel];
}
LightShare fetch_share(int pixel) {
  return args.shares.at[pixel];
}

#include "rsm/share_blur.inl.h"

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID);
  if (at.x >= args.width || at.y >= args.height) return;
  ivec2 axis = args.is_last != 0u ? ivec2(0, 1) : ivec2(1, 0);
  LightShare share = blurred_share(at, ivec2(args.width, args.height), axis, args.period,
                                   args.inverse_tolerance);
  int i = at.y * args.width + at.x;
  if (args.is_last == 0u) {
    args.blurred.at[i] = share;
    return;
  }
  args.direct.at[i] =
      with_brightest(args.brightest.at[i], args.direct.at[i], arriving_share(share));
}
