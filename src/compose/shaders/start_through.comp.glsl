// SPDX-License-Identifier: Apache-2.0
// Prepares a band's pixels for a sample of transmitted light; see SeenThrough::start().
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/glossy/seen_through_records.h"
#include "compose/shaders/shown_gather.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  StartThroughArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first + i;
  args.seen.at[0].emitter_albedo.at[pixel] = vec3(0.0f);
  args.seen.at[0].coat_albedo.at[pixel] = vec3(0.0f);
  args.seen.at[0].albedo.at[pixel] = vec3(0.0f);
  if (args.gathers != 0u) {
    args.seen.at[0].bases.at[i] = no_shown_base();
    args.seen.at[0].gather.albedo.at[pixel] = vec3(0.0f);
  }
  if (args.long_ways != 0u) args.seen.at[0].glass_depths.at[pixel] = 0.0f;
  if ((args.surfaces.at[i].flags & kSurfaceSkipped) != 0u) return;
  args.seen.at[0].depths.at[pixel] = 0.0f;
  args.seen.at[0].emitters.at[pixel] = vec3(0.0f);
  args.seen.at[0].emitter_variance.at[pixel] = 0.0f;
  args.seen.at[0].emitter_levels.at[pixel] = 0.0f;
  args.seen.at[0].coats.at[pixel] = vec3(0.0f);
  args.seen.at[0].coat_lobes.at[pixel].sharpness = 0.0f;
  args.seen.at[0].coat_distances.at[pixel] = -1.0f;
  args.seen.at[0].distances.at[pixel] = -1.0f;
  args.seen.at[0].light.at[pixel] = vec3(0.0f);
  if (args.long_ways != 0u) args.seen.at[0].long_ways.at[pixel] = vec3(0.0f);
  if (args.gathers != 0u) empty_shown_gather(args.seen.at[0].gather, pixel);
  args.seen.at[0].lobes.at[pixel].sharpness = 0.0f;
}
