// SPDX-License-Identifier: Apache-2.0
// Weights of a lookup's corners by visibility rays. The includer has declared push constants with
// `args.store`.
#ifndef LAMBENT_FIELD_LOOKUP_SHADERS_SEEN_CORNERS_GLSL
#define LAMBENT_FIELD_LOOKUP_SHADERS_SEEN_CORNERS_GLSL

#include "field/probes/shaders/store.glsl"
#include "field/lookup/visibility_math.h"
#include "field/lookup/lookup.inl.h"

/// The volume that a lookup reads.
ProbeGrid grid_of(CornerWeights corners) {
  return args.store.grids.at[int(corners.table) / kCellWraps];
}

/// A ray from the biased position of a query to a corner. The biased position is off the surface,
/// so that rounding cannot make the ray hit the surface itself.
RayRecord corner_ray(CornerWeights corners, int corner, QueryRecord query) {
  ProbeGrid grid = grid_of(corners);
  vec3 from_ws = biased_position(query.position_ws, query.normal_ws, query.to_viewer_ws,
                                 smallest_spacing(grid));
  ivec3 coords = probe_coords(grid, corners.base) + cell_corner(corner);
  return visibility_ray(from_ws, placed_probe(grid, coords));
}

/// The weights that the corners have if they are visible. Probes inside geometry have no weight by
/// distances, and get none here.
CornerWeights seen_corners(CornerWeights corners, QueryRecord query) {
  ProbeGrid grid = grid_of(corners);
  ProbeCell cell = probe_cell(grid, query.position_ws);
  CornerWeights seen = corners;
  for (int k = 0; k < kCellCorners; ++k) {
    ivec3 offset = cell_corner(k);
    float cosine =
        probe_cosine(placed_probe(grid, cell.base + offset), query.position_ws, query.normal_ws);
    seen.weight[k] = corners.weight[k] > 0.0
                         ? seen_weight(trilinear_weight(cell.fraction, offset), wrap_weight(cosine))
                         : 0.0;
  }
  return seen;
}

/// The corners with a weight above 0, as bits.
uint weighed_corners(CornerWeights corners) {
  uint weighed = 0u;
  for (int k = 0; k < kCellCorners; ++k) {
    if (corners.weight[k] > 0.0) weighed |= 1u << k;
  }
  return weighed;
}

/// Sets the weights of hidden corners to 0, and scales the others to the sum `total`. Returns false
/// where no corner is left.
bool hide_corners(inout CornerWeights corners, uint hidden, float total) {
  for (int k = 0; k < kCellCorners; ++k) {
    if ((hidden >> k & 1u) != 0u) corners.weight[k] = 0.0;
  }
  return scale_weights(corners, total) != 0;
}

#endif
