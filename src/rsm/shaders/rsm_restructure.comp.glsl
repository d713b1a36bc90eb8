// SPDX-License-Identifier: Apache-2.0
// Restructures a map into sub-maps.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/deinterleave.h"
#include "rsm/vulkan/device_passes.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push {
  RestructureArguments args;
};

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID);
  if (texel.x >= args.resolution || texel.y >= args.resolution) return;
  args.sub_maps.at[sub_map_texel(texel, args.resolution, args.count)] =
      args.rendered.at[texel.y * args.resolution + texel.x];
}
