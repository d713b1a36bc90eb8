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

#define FieldRef Vec4Array
#define SurfelLookupRef SurfelLookup
#define CornerOffsetsRef CornerOffsets
#define TapsRef int[4]
#define TileRef int

CornerOffsets fetch_offsets(Vec4Array field, uint table) {
  return args.corners.at[table];
}
int[4] fetch_taps(Vec4Array field, uint tile_corner) {
  const int places = kIrradianceTexels + 1;
  ivec2 corner = ivec2(int(tile_corner) % places, int(tile_corner) / places);
  int taps[4];
  for (int tap = 0; tap < 4; ++tap) {
    ivec2 source = tile_source(corner + ivec2(tap & 1, tap >> 1), kIrradianceTexels);
    taps[tap] = source.x + kIrradianceTexels * source.y;
  }
  return taps;
}
int fetch_tile(Vec4Array field, int probe) {
  return probe * kTexels;
}
vec4 fetch_texel(Vec4Array field, int tile, int texel) {
  return field.at[tile + texel];
}

#include "field/transport/gather.inl.h"

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.probes || ray >= args.radiance_stride) return;
  int probe = args.list.probes.at[k];
  int rays = args.list.sets.at[args.list.ray_sets.at[k]].rays;
  bool there = ray < rays;
  int slot = probe * args.stride + min(ray, rays - 1);
  SurfelRecord surfel = args.surfels.at[slot];

  vec3 arrives = surfel.light;
  if (there && args.light == kGatherAll && surfel.albedo_over_pi != vec3(0.0)) {
    for (int l = 0; l < kLookups; ++l) {
      SurfelLookup lookup = args.lookups.at[slot * kLookups + l];
      if (lookup.tile_corner != kNoLookup) arrives += vec3(read_field(args.field, lookup));
    }
  }
  vec4 radiance =
      sent_radiance(surfel.kind, surfel.albedo_over_pi, arrives, args.light != kGatherSky);
  args.radiance.at[k * args.radiance_stride + ray] = there ? radiance : vec4(0.0);
}
