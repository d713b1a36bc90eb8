// SPDX-License-Identifier: Apache-2.0
// Converts sampled light to the format that passes of the filter read.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "denoise/denoise_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  DenoiseStartArguments args;
};

// What fireflies.inl.h requires of its includer.
#define NoisyPixelRef ivec2

float fetch_luminance(ivec2 pixel, int x, int y) {
  ivec2 place = pixel + ivec2(x, y);
  ivec2 size = ivec2(int(args.width), int(args.count / args.width));
  if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size))) return 0.0f;
  return luminance(finite_or_dark(args.light.at[place.y * size.x + place.x]));
}

#include "denoise/fireflies.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  vec3 light = finite_or_dark(args.light.at[i]);
  vec3 base = args.has_base != 0u ? finite_or_dark(args.base.at[i]) : vec3(0.0f);
  float spread = args.measured != 0u ? finite_or_dark(args.variance.at[i])
                                     : unmeasured_spread(light, base);
  if (args.part != kWholeLight) {
    float share = firefly_share(ivec2(int(i % args.width), int(i / args.width)), spread);
    if (args.part == kWithoutFireflies) share = 1.0f - share;
    light *= share;
    bool known = args.part == kWithoutFireflies;
    spread = known ? spread * share * share : unmeasured_spread(light, base);
  }
  args.out_light.at[i] = DenoiseRecord(light, spread, base, 1.0f);
}
