// SPDX-License-Identifier: Apache-2.0
// Upsamples the light of the small view to the surfaces of the frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/vulkan/device_passes.h"
#include "rsm/upsample.h"

layout(local_size_x = 32, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  UpsampleArguments args;
};

vec3 fetch_position(int pixel) {
  return args.small.positions_ws.at[pixel];
}
vec3 fetch_normal(int pixel) {
  return args.small.normals_ws.at[pixel];
}
vec3 fetch_light(int pixel) {
  return args.light.at[pixel];
}

#include "rsm/upsample.inl.h"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID);
  if (pixel.x >= args.width || pixel.y >= args.height) return;
  int i = pixel.y * args.width + pixel.x;
  float depth = args.surfaces.depths.at[i];
  vec3 light = vec3(0.0f);
  vec2 in_frame = vec2(pixel.x, pixel.y + args.first_row);
  if (depth > 0.0f) {
    light = upsample_light(ivec2(args.small_width, args.small_height),
                           place_in_small_picture(in_frame, args.inverse_downscale),
                           args.surfaces.positions_ws.at[i], args.surfaces.normals_ws.at[i],
                           1.0f / (args.plane_tolerance * depth));
  }
  args.irradiance.at[i] = light;
}
