// SPDX-License-Identifier: Apache-2.0
// Merges what mirrors show into the hits, one lane per hit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/mirrors/mirror_math.h"
#include "raytracing/vulkan/shading_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  MirrorLightArguments args;
};

void main() {
  if (gl_GlobalInvocationID.x >= args.count) return;
  uint i = args.first + gl_GlobalInvocationID.x;
  if (args.reflected.at[i].mask == 0u) return;
  LitHit both = shown_by_mirror(LitHit(args.shaded.at[i], args.irradiance.at[i]),
                                LitHit(args.shown.at[i], args.shown_irradiance.at[i]),
                                args.hits.at[i].distance);
  args.shaded.at[i] = both.hit;
  args.irradiance.at[i] = both.irradiance;
  args.points.at[i] = args.shown_points.at[i];
}
