// SPDX-License-Identifier: Apache-2.0
// How points read the field: a lane a point. Where more volumes than it has lookups have a share in
// what a point sees, those asked first answer for all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  FindLookupsArguments args;
};

#include "field/lookup/shaders/lookup_points.glsl"
#include "field/probes/shaders/store.glsl"
#include "field/lookup/visibility_math.h"
#include "field/lookup/lookup.inl.h"
#include "field/lookup/lookup_weights.inl.h"

void main() {
  LookupPoint point = lookup_point();
  if (!point.exists) return;
  QueryRecord query = query_of(point);
  TileFetch fetch = tile_fetch(query.normal_ws, kIrradianceTexels);
  uint corner = uint(fetch.corner.x + (kIrradianceTexels + 1) * fetch.corner.y);

  int found = 0;
  float left = reads_field(point) ? 1.0 : 0.0;
  for (int volume = 0; volume < kVolumes; ++volume) {
    if (left <= kNothingLeft || found == kLookups) continue;
    ProbeGrid grid = args.store.grids.at[volume];
    float volume_weight = volume + 1 == kVolumes ? 1.0 : volume_blend_weight(grid, query.position_ws);
    if (volume_weight <= 0.0) continue;
    CornerWeights corners =
        lookup_weights(grid, volume, query.position_ws, query.normal_ws, query.to_viewer_ws);
    // Where the volume knows nothing, coarser ones answer for it
    if (sum_of_weights(corners) == 0.0) continue;
    volume_weight *= left;
    left -= volume_weight;
    for (int c = 0; c < kCellCorners; ++c) corners.weight[c] *= volume_weight;
    args.lookups.at[point.lookup + found] =
        SurfelLookup(corners, corner, fetch.fraction.x, fetch.fraction.y);
    ++found;
  }

  // Where it is the last that knows nothing, those before answer for all
  for (int l = 0; l < kLookups; ++l) {
    if (l >= found) {
      args.lookups.at[point.lookup + l].tile_corner = kNoLookup;
    } else if (left > kNothingLeft) {
      for (int c = 0; c < kCellCorners; ++c) {
        args.lookups.at[point.lookup + l].corners.weight[c] /= 1.0 - left;
      }
    }
  }
}
