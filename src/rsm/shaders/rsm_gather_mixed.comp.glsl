// SPDX-License-Identifier: Apache-2.0
// Gathers the light of sub-maps at the pixels of a picture that is not restructured, where
// neighbours use different sub-maps. The baseline that restructuring is compared with.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/gather_pixel.glsl"

layout(push_constant, scalar) uniform Push {
  RsmGatherArguments args;
};

void main() {
  Pixel pixel;
  ivec2 size = ivec2(args.width, args.height);
  if (!find_pixel(args.view, size, own_place(0), pixel)) return;
  bool directions = (args.flags & kGatherBlurred) != 0u;
  bool rendered = (args.flags & kGatherRendered) != 0u;
  uint start = uint(sub_map_of(pixel.at, args.sub_maps) * args.count);
  TexelLight sum = {vec3(0.0f), vec3(0.0f)};
  for (int k = 0; k < args.count; ++k) {
    uint at = start + uint(k);
    RsmTexelRecord texel = args.texels.at[rendered ? args.places.at[at] : at];
    texel.flux *= kInvPi;
    TexelSight sight = see_texel_record(pixel.position_ws, pixel.normal_ws, texel);
    gather_texel(sum, sight, texel);
    if (directions && k % kTexelsPerDirection == 0) gather_direction(sum, sight, texel);
  }
  finish_pixel(args.view, args.target, size, args.flags, pixel, sum);
}
