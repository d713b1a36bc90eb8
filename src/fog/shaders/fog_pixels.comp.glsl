// SPDX-License-Identifier: Apache-2.0
// Computes the effect of fog on pixels; see fog_along().
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/pixel_math.h"
#include "fog/fog_records.h"
#include "shared/phase.h"

#define MediaRef FogArray
#define FroxelsRef FogArray

uint media_count(FogArray fog) {
  return fog.at[0].media_count;
}
MediumRecord fetch_medium(FogArray fog, uint medium) {
  return fog.at[0].media.at[medium];
}
vec4 fetch_froxel(FogArray fog, uint index) {
  return fog.at[0].froxels.at[index];
}

#include "scene/media/media.inl.h"
#include "fog/froxels.inl.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  FogPixelsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first_pixel + i;
  vec2 corner = vec2(float(pixel % args.width), float(pixel / args.width));
  vec2 offset = subpixel_position(args.index, args.samples, args.seed, args.jitter);
  RayRecord ray = args.rays.at[i];
  args.light.at[i] = fog_along(args.fog.at[0].grid, args.fog, args.fog, corner + offset,
                               ray.origin_ws, ray.direction_ws, args.hits.at[i].distance);
}
