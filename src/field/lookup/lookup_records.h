// SPDX-License-Identifier: Apache-2.0
// How a point reads the field, once it is known what the probes around it weigh.
#ifndef LAMBENT_FIELD_LOOKUP_LOOKUP_RECORDS_H
#define LAMBENT_FIELD_LOOKUP_LOOKUP_RECORDS_H

#include "field/probes/probe_grid.h"

LAMBENT_BEGIN

/// Index of each corner of a cell relative to that of the cell's lowest probe.
struct CornerOffsets {
  int probe[kCellCorners];
};

/// The eight probes around a point: corner k (bit 0 x, bit 1 y, bit 2 z) of the cell whose lowest
/// probe is `base` counts `weight[k]`. Weights sum to 1, or to the share that the volume has in the
/// answer.
struct CornerWeights {
  int base;
  uint table;  ///< Where the corners lie relative to it, in ProbeStore::corner_table.
  float weight[kCellCorners];
};

/// How a surfel reads the field: the shares of the eight probes around it, and, within each of
/// their tiles, the four texels around its normal (a place in the tile's interior grid, counted
/// with gutter).
struct SurfelLookup {
  CornerWeights corners;
  uint tile_corner;  ///< x + (texels + 1) * y of the fetch's first texel.
  float fraction_x;
  float fraction_y;
};

LAMBENT_END
#endif
