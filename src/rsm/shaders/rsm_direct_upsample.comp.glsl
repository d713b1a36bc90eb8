// SPDX-License-Identifier: Apache-2.0
// Adds the view's direct light to that of a frame's pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/upsample.h"
#include "rsm/vulkan/device_direct.h"
#include "shared/demodulate.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  DirectUpsampleArguments args;
};

vec3 fetch_position(int pixel) {
  return args.view.positions_ws.at[pixel];
}
vec3 fetch_normal(int pixel) {
  return args.view.normals_ws.at[pixel];
}
ReflectedPair fetch_direct(int pixel) {
  return args.direct.at[pixel];
}

#include "rsm/direct_upsample.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count || (args.surfaces.at[i].flags & kSurfaceMissed) != 0u) return;
  LitPointRecord point = args.points.at[i];
  float depth = -dot(point.position_ws - args.camera_ws, args.camera_back);
  vec2 in_frame = vec2(i % uint(args.width), i / uint(args.width) + uint(args.first_row));
  ReflectedPair pair =
      upsample_direct(ivec2(args.view_width, args.view_height),
                      place_in_small_picture(in_frame, args.inverse_downscale), point.position_ws,
                      point.normal_ws, 1.0f / (args.plane_tolerance * depth));
  args.diffuse.at[i] += pair.diffuse * filtered_albedo(args.surfaces.at[i].reflectance);
  args.specular.at[i] += pair.specular;
}
