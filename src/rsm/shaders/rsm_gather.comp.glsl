// SPDX-License-Identifier: Apache-2.0
// Gathers the light of a sub-map at the pixels of the sub-images that use it. All pixels of a
// workgroup are of one sub-image, so that its texels are fetched once for all of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/gather_pixel.glsl"

layout(push_constant, scalar) uniform Push {
  RsmGatherArguments args;
};

const int kGroup = int(gl_WorkGroupSize.x * gl_WorkGroupSize.y);
const int kTexelVectors = 3;
shared vec4 staged[kGroup * kTexelVectors];

/// Has each invocation fetch one texel; those beyond the last have no light.
void stage_texel(int sub_map, int k) {
  RsmTexelRecord texel = {vec3(0.0f), 0.0f, vec3(0.0f), 1.0f, vec3(0.0f), 0.0f};
  if (k < args.count) {
    uint at = uint(sub_map * args.count + k);
    texel = args.texels.at[(args.flags & kGatherRendered) != 0u ? args.places.at[at] : at];
  }
  uint i = gl_LocalInvocationIndex * kTexelVectors;
  staged[i] = vec4(texel.position_ws, texel.softening);
  staged[i + 1] = vec4(texel.normal_ws, 0.0f);
  staged[i + 2] = vec4(texel.flux * kInvPi, 0.0f);
}

RsmTexelRecord staged_texel(int k) {
  vec4 a = staged[k * kTexelVectors];
  vec4 b = staged[k * kTexelVectors + 1];
  vec4 c = staged[k * kTexelVectors + 2];
  RsmTexelRecord texel = {vec3(a), 0.0f, vec3(b), a.w, vec3(c), 0.0f};
  return texel;
}

/// Places of this invocation's pixels, one below the other by a tile's height.
ivec2 place_of(int i) {
  ivec2 place = own_place(0);
  int rows = int(gl_WorkGroupSize.y);
  return ivec2(place.x, place.y + rows * (int(gl_WorkGroupID.y) * (kGatherPixels - 1) + i));
}

void main() {
  Pixel pixels[kGatherPixels];
  bool exists[kGatherPixels];
  TexelLight sums[kGatherPixels];
  ivec2 size = ivec2(args.width, args.height);
  for (int i = 0; i < kGatherPixels; ++i) {
    exists[i] = find_pixel(args.view, size, place_of(i), pixels[i]);
    sums[i] = TexelLight(vec3(0.0f), vec3(0.0f));
  }
  bool directions = (args.flags & kGatherBlurred) != 0u;
  int sub_map = sub_map_of(sub_image_of_group(kSubImages), args.sub_maps);
  for (int first = 0; first < args.count; first += kGroup) {
    barrier();
    stage_texel(sub_map, first + int(gl_LocalInvocationIndex));
    barrier();
    int count = min(kGroup, args.count - first);
    for (int k = 0; k < count; ++k) {
      RsmTexelRecord texel = staged_texel(k);
      for (int i = 0; i < kGatherPixels; ++i) {
        TexelSight sight = see_texel_record(pixels[i].position_ws, pixels[i].normal_ws, texel);
        gather_texel(sums[i], sight, texel);
        if (directions && k % kTexelsPerDirection == 0) gather_direction(sums[i], sight, texel);
      }
    }
  }
  for (int i = 0; i < kGatherPixels; ++i) {
    if (exists[i]) finish_pixel(args.view, args.target, size, args.flags, pixels[i], sums[i]);
  }
}
