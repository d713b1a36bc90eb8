// SPDX-License-Identifier: Apache-2.0
// Finds the lookups of points, with visibility by distances, one lane per point. A point has
// kLookups lookups; where more volumes have a weight at the point, the first ones take all of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  FindLookupsArguments args;
};

#include "field/correction/shaders/corrections.glsl"
#include "field/lookup/shaders/lookup_points.glsl"
#include "field/probes/shaders/store.glsl"
#include "field/lookup/visibility_math.h"

float fetch_correction(ProbeGrid grid, int volume, vec3 position_ws, vec3 normal_ws) {
  return correction_of(args.corrections, grid, volume, position_ws, normal_ws);
}

#include "field/lookup/lookup.inl.h"

/// The weights of the eight probes around a point in one volume. They sum to 1, or to 0 where all
/// of these probes are inside geometry.
CornerWeights lookup_weights(LookupGrid in_volume, int volume, QueryRecord query) {
  LookupCell cell = lookup_cell(in_volume, query.position_ws, query.normal_ws, query.to_viewer_ws,
                                query.viewer_distance);
  CornerWeights weights = corner_weights(in_volume, cell, query.position_ws, query.normal_ws);
  weights.table = uint(kCellWraps * volume + cell_wrap(in_volume.grid, cell.cell.base));
  normalize_weights(weights);
  return weights;
}

void main() {
  LookupPoint point = lookup_point();
  if (!point.exists) return;
  QueryRecord query = query_of(point);
  TileFetch fetch = tile_fetch(query.normal_ws, kIrradianceTexels);
  uint corner = uint(fetch.corner.x + (kIrradianceTexels + 1) * fetch.corner.y);

  int found = 0;
  float gi_share = gi_share_of(point);
  float left = gi_share > 0.0 ? 1.0 : 0.0;
  for (int volume = 0; volume < kVolumes; ++volume) {
    if (left <= kMinRemainingWeight || found == kLookups) continue;
    ProbeGrid grid = args.store.grids.at[volume];
    float volume_weight = volume_share(grid, volume, kVolumes, query.position_ws);
    if (volume_weight <= 0.0) continue;
    CornerWeights corners = lookup_weights(lookup_grid(grid), volume, query);
    // Where no probe of this volume is visible, the next volumes take its weight
    if (sum_of_weights(corners) == 0.0) continue;
    volume_weight *= left;
    left -= volume_weight;
    float ratio = fetch_correction(grid, volume, query.position_ws, query.normal_ws);
    float weight = volume_weight * gi_share * ratio;
    for (int c = 0; c < kCellCorners; ++c) corners.weight[c] *= weight;
    args.lookups.at[point.lookup + found] =
        SurfelLookup(corners, corner, fetch.fraction.x, fetch.fraction.y);
    ++found;
  }

  // Where no probe of the last volume is visible, scale up the weights of the volumes before it
  for (int l = 0; l < kLookups; ++l) {
    if (l >= found) {
      args.lookups.at[point.lookup + l].tile_corner = kNoLookup;
    } else if (left > kMinRemainingWeight) {
      for (int c = 0; c < kCellCorners; ++c) {
        args.lookups.at[point.lookup + l].corners.weight[c] /= 1.0 - left;
      }
    }
  }
}
