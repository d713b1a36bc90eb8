// SPDX-License-Identifier: Apache-2.0
// Makes a ray through the middle of each texel of a map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/vulkan/device_maps.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push {
  MapRaysArguments args;
};

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID);
  if (texel.x >= args.resolution || texel.y >= args.resolution) return;
  MapRay ray = map_ray(args.projection, texel_middle(texel.x, texel.y, args.resolution));
  args.rays.at[texel.y * args.resolution + texel.x] =
      RayRecord(ray.origin_ws, 0.0f, ray.direction_ws, infinity(), args.mask);
}
