// SPDX-License-Identifier: Apache-2.0
// The volumes, cells and weights for the visibility rays of lookups. The includer has declared push
// constants with `args.store` and `args.counter`.
#ifndef LAMBENT_FIELD_LOOKUP_SHADERS_VISIBILITY_RAYS_GLSL
#define LAMBENT_FIELD_LOOKUP_SHADERS_VISIBILITY_RAYS_GLSL

#include "field/probes/shaders/store.glsl"
#include "field/lookup/visibility_math.h"
#include "field/lookup/visibility.inl.h"

/// Whether a point exists: the device may have decided how many rows there are.
bool is_listed(LookupPoint point) {
  uint row = args.counter.at[kFirstItem] + uint(point.row);
  return point.exists && row < args.counter.at[kRowsListed];
}

/// The volume that a lookup reads.
LookupGrid grid_of(CornerWeights corners) {
  return lookup_grid(args.store.grids.at[int(corners.table) / kCellWraps]);
}

/// The cell that a lookup reads in this volume.
LookupCell cell_of(LookupGrid volume, QueryRecord query) {
  return lookup_cell(volume, query.position_ws, query.normal_ws, query.to_viewer_ws,
                     query.viewer_distance);
}

/// visible_corners() of a point's lookup.
CornerWeights visible_corners(CornerWeights corners, QueryRecord query) {
  LookupGrid volume = grid_of(corners);
  return visible_corners(volume, cell_of(volume, query), corners, query.position_ws,
                         query.normal_ws);
}

#endif
