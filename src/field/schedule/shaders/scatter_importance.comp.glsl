// SPDX-License-Identifier: Apache-2.0
// Scatters the importance of probes through their surfels to the probes that these read, one lane
// per surfel. Sums are of fixed-point numbers, so that the order of additions does not matter.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/schedule/importance_math.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  ScatterImportanceArguments args;
};

void main() {
  int ray = int(gl_GlobalInvocationID.x * kSurfelsPerScatter);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count) return;
  int rays = args.list.sets.at[args.list.ray_sets.at[k]].rays;
  if (ray >= rays) return;
  int probe = args.list.probes.at[k];
  int slot = probe * args.stride + ray;
  SurfelRecord surfel = args.surfels.at[slot];
  if (surfel.kind != kSurfelSurface || surfel.albedo_over_pi == vec3(0.0)) return;
  float takes = args.scale *
                scattered_importance(args.received.at[probe], rays, surfel.albedo_over_pi);
  for (int l = 0; l < kLookups; ++l) {
    SurfelLookup lookup = args.lookups.at[slot * kLookups + l];
    if (lookup.tile_corner == kNoLookup) continue;
    CornerOffsets offsets = args.corners.at[lookup.corners.table];
    for (int corner = 0; corner < kCellCorners; ++corner) {
      uint sent = uint(takes * lookup.corners.weight[corner] + 0.5);
      atomicAdd(args.sent.at[lookup.corners.base + offsets.probe[corner]], sent);
    }
  }
}
