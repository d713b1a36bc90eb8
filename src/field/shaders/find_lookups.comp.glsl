// SPDX-License-Identifier: Apache-2.0
// How surfels read the field: a lane a surfel. Where more volumes than it has lookups have a
// share in what a surfel sees, those asked first answer for all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/device_arguments.h"
#include "shared/octahedral.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  FindLookupsArguments args;
};

#include "field/shaders/store.glsl"
#include "field/lookup.inl.h"
#include "field/lookup_weights.inl.h"

float sum_of(CornerWeights corners) {
  float sum = 0.0;
  for (int corner = 0; corner < kCellCorners; ++corner) sum += corners.weight[corner];
  return sum;
}

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.probes || ray >= args.stride) return;
  int first = (args.list.probes.at[k] * args.stride + ray) * kLookups;
  RaySetRecord set = args.list.sets.at[args.list.ray_sets.at[k]];
  SurfelRecord surfel = args.surfels.at[args.list.probes.at[k] * args.stride + ray];
  bool reads = ray < set.rays && surfel.receives_gi != 0u && surfel.albedo_over_pi != vec3(0.0);
  vec3 normal = decode_unit_vector(surfel.normal_ws);
  vec3 to_viewer = -set.directions.at[min(ray, set.rays - 1)];
  TileFetch fetch = tile_fetch(normal, kIrradianceTexels);
  uint corner = uint(fetch.corner.x + (kIrradianceTexels + 1) * fetch.corner.y);

  int found = 0;
  float left = reads ? 1.0 : 0.0;
  for (int volume = 0; volume < kVolumes; ++volume) {
    if (left <= kNothingLeft || found == kLookups) continue;
    ProbeGrid grid = args.store.grids.at[volume];
    float share = volume + 1 == kVolumes ? 1.0 : volume_share(grid, surfel.position_ws);
    if (share <= 0.0) continue;
    CornerWeights corners = lookup_weights(grid, volume, surfel.position_ws, normal, to_viewer);
    // Where the volume knows nothing, coarser ones answer for it
    if (sum_of(corners) == 0.0) continue;
    share *= left;
    left -= share;
    for (int c = 0; c < kCellCorners; ++c) corners.weight[c] *= share;
    args.lookups.at[first + found] =
        SurfelLookup(corners, corner, fetch.fraction.x, fetch.fraction.y);
    ++found;
  }

  // Where it is the last that knows nothing, those before answer for all
  for (int l = 0; l < kLookups; ++l) {
    if (l >= found) {
      args.lookups.at[first + l].tile_corner = kNoLookup;
    } else if (left > kNothingLeft) {
      for (int c = 0; c < kCellCorners; ++c) {
        args.lookups.at[first + l].corners.weight[c] /= 1.0 - left;
      }
    }
  }
}
