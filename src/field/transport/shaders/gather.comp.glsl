// SPDX-License-Identifier: Apache-2.0
// Gathers the radiance along probes' rays, one lane per ray. The fourth channel is 1 for rays that
// count.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/probes/shaders/tiles.glsl"
#include "field/probes/tile.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  GatherArguments args;
};

const int kTexels = kIrradianceTexels * kIrradianceTexels;

/// The irradiance that a lookup reads from the field.
vec3 read_field(SurfelLookup lookup) {
  ivec2 corner = ivec2(int(lookup.tile_corner) % (kIrradianceTexels + 1),
                       int(lookup.tile_corner) / (kIrradianceTexels + 1));
  CornerOffsets offsets = args.corners.at[lookup.corners.table];
  float fx = lookup.fraction_x;
  float fy = lookup.fraction_y;
  float tap_weights[4] =
      float[]((1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy);
  int taps[4];
  for (int tap = 0; tap < 4; ++tap) {
    ivec2 source = tile_source(corner + ivec2(tap & 1, tap >> 1), kIrradianceTexels);
    taps[tap] = source.x + kIrradianceTexels * source.y;
  }
  vec3 sum = vec3(0.0);
  for (int k = 0; k < kCellCorners; ++k) {
    int tile = (lookup.corners.base + offsets.probe[k]) * kTexels;
    for (int tap = 0; tap < 4; ++tap) {
      sum += args.field.at[tile + taps[tap]].xyz * (lookup.corners.weight[k] * tap_weights[tap]);
    }
  }
  return sum;
}

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.probes || ray >= args.radiance_stride) return;
  int probe = args.list.probes.at[k];
  int rays = args.list.sets.at[args.list.ray_sets.at[k]].rays;
  bool there = ray < rays;
  int slot = probe * args.stride + min(ray, rays - 1);
  SurfelRecord surfel = args.surfels.at[slot];

  vec3 reflectance = surfel.kind == kSurfelSky       ? vec3(1.0)
               : args.light != kGatherSky      ? surfel.albedo_over_pi
                                               : vec3(0.0);
  vec3 arrives = surfel.light;
  if (there && args.light == kGatherAll && surfel.albedo_over_pi != vec3(0.0)) {
    for (int l = 0; l < kLookups; ++l) {
      SurfelLookup lookup = args.lookups.at[slot * kLookups + l];
      if (lookup.tile_corner != kNoLookup) arrives += read_field(lookup);
    }
  }
  float counts = there && surfel.kind != kSurfelSolidSide ? 1.0 : 0.0;
  vec4 radiance = there ? vec4(reflectance * arrives, counts) : vec4(0.0);
  args.radiance.at[k * args.radiance_stride + ray] = radiance;
}
