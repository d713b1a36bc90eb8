// SPDX-License-Identifier: Apache-2.0
// Lookups with their weights, as C++ and GLSL both read them.
#ifndef LAMBENT_FIELD_LOOKUP_LOOKUP_RECORDS_H
#define LAMBENT_FIELD_LOOKUP_LOOKUP_RECORDS_H

#include "field/probes/probe_grid.h"

LAMBENT_BEGIN

/// The index of each corner of a cell relative to the index of the cell's lowest probe.
struct CornerOffsets {
  int probe[kCellCorners];
};

/// The weights of the eight probes around a point. Corner k (bit 0 x, bit 1 y, bit 2 z) of the cell
/// whose lowest probe is `base` has `weight[k]`. The weights sum to 1, or to the volume's weight in
/// the lookup, times the correction and the share of irradiance that the point receives.
struct CornerWeights {
  int base;
  uint table;  ///< The cell's entry in ProbeStore::corner_table.
  float weight[kCellCorners];
};

LAMBENT_FN float sum_of_weights(CornerWeights corners) {
  float sum = 0.0f;
  LAMBENT_UNROLL for (int k = 0; k < kCellCorners; ++k) sum += corners.weight[k];
  return sum;
}

/// Scales weights to a sum of 1. Leaves them as they are where all are 0.
LAMBENT_FN void normalize_weights(LAMBENT_INOUT(CornerWeights) corners) {
  float sum = sum_of_weights(corners);
  float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
  for (int k = 0; k < kCellCorners; ++k) corners.weight[k] *= scale;
}

/// How a surfel reads the field: with the weights of the eight probes around it and, in each of
/// their tiles, a bilinear fetch along its normal.
struct SurfelLookup {
  CornerWeights corners;
  uint tile_corner;  ///< x + (texels + 1) * y of the fetch's first texel, gutter included.
  float fraction_x;
  float fraction_y;
};

LAMBENT_END
#endif
