// SPDX-License-Identifier: Apache-2.0
// Which of the eight probes around a point are tested with visibility rays, and the weights that
// result.
#ifndef LAMBENT_FIELD_LOOKUP_VISIBILITY_MATH_H
#define LAMBENT_FIELD_LOOKUP_VISIBILITY_MATH_H

#include "field/lookup/lookup.h"
#include "field/lookup/lookup_records.h"
#include "raytracing/ray_records.h"

LAMBENT_BEGIN

// The number of pairs of probes of a cell.
const int kCellPairs = kCellCorners * (kCellCorners - 1) / 2;

// Probes that are not visible from the cell's heaviest corner count as hidden if their weight is
// below this share of the sum of weights. Where one has a larger weight, all that have are tested
// with rays.
const float kMinTestedWeight = 0.05f;

/// A ray that is occluded where two points are not visible to each other.
LAMBENT_FN RayRecord visibility_ray(vec3 from_ws, vec3 to_ws) {
  vec3 way = to_ws - from_ws;
  float distance = max(length(way), kMinProbeDistance);
  RayRecord ray = {from_ws, 0.0f, way / distance, distance, kRayOfProbe};
  return ray;
}

/// The two corners of one of the kCellPairs pairs of a cell, which are numbered from 0.
LAMBENT_FN ivec2 cell_pair(int pair) {
  int corner = 0;
  int others = kCellCorners - 1;
  while (pair >= others) {
    pair -= others;
    ++corner;
    --others;
  }
  return ivec2(corner, corner + 1 + pair);
}

/// All corners of a cell are visible to each other: bit 8 i + k is 1 where corner k is visible from
/// corner i. The first 32 bits are in x.
LAMBENT_FN uvec2 all_visible() {
  return uvec2(0xFFFFFFFFu, 0xFFFFFFFFu);
}

/// Clears the bits of a pair of corners that are not visible to each other.
LAMBENT_FN uvec2 without_pair(uvec2 cell_visibility, ivec2 pair) {
  for (int side = 0; side < 2; ++side) {
    int bit = kCellCorners * pair[side] + pair[1 - side];
    cell_visibility[bit >> 5] &= ~(1u << uint(bit & 31));
  }
  return cell_visibility;
}

/// The corners that are visible from a corner, as the lowest bits.
LAMBENT_FN uint corners_seen_by(uvec2 cell_visibility, int corner) {
  int bit = kCellCorners * corner;
  return cell_visibility[bit >> 5] >> uint(bit & 31);
}

/// The corner with the largest weight.
LAMBENT_FN int heaviest_corner(CornerWeights corners) {
  int heaviest = 0;
  for (int k = 1; k < kCellCorners; ++k) {
    if (corners.weight[k] > corners.weight[heaviest]) heaviest = k;
  }
  return heaviest;
}

/// Scales weights to a sum of `total`. Returns 0 where all weights are 0, else 1.
LAMBENT_FN int scale_weights(LAMBENT_INOUT(CornerWeights) corners, float total) {
  float sum = sum_of_weights(corners);
  if (!(sum > 0.0f)) return 0;
  for (int k = 0; k < kCellCorners; ++k) {
    corners.weight[k] = corners.weight[k] / sum * total;
  }
  return 1;
}

/// The corners of a lookup whose visibility is in doubt, as bits: those that count as hidden, and
/// those that are tested with rays.
struct VisibilityMask {
  uint hidden;
  uint tested;
};

/// Hybrid visibility. `corners` has weights by distances with a sum of `total`. Where a corner with
/// a large weight is not visible from the heaviest one, either of the two may be behind a wall.
/// Next to the edge of a door the heaviest one often is, and which corner that is changes from
/// point to point. All corners with a large weight are therefore tested.
LAMBENT_FN VisibilityMask visibility_mask(CornerWeights corners, uvec2 cell_visibility,
                                          float total) {
  uint visible = corners_seen_by(cell_visibility, heaviest_corner(corners));
  uint heavy = 0u;
  VisibilityMask mask = {0u, 0u};
  for (int k = 0; k < kCellCorners; ++k) {
    uint bit = 1u << uint(k);
    if (corners.weight[k] <= 0.0f) continue;
    bool counts = corners.weight[k] >= kMinTestedWeight * total;
    if (counts) heavy |= bit;
    if (!counts && (visible & bit) == 0u) mask.hidden |= bit;
  }
  if ((heavy & ~visible) != 0u) mask.tested = heavy;
  return mask;
}

/// Sets the weights of hidden corners, given as bits, to 0.
LAMBENT_FN void hide_corners(LAMBENT_INOUT(CornerWeights) corners, uint hidden) {
  for (int k = 0; k < kCellCorners; ++k) {
    if ((hidden >> uint(k) & 1u) != 0u) corners.weight[k] = 0.0f;
  }
}

/// The weights of a lookup after its rays, with a sum of `total`: those of `before`, without the
/// corners in `hidden`, given as bits. Where no weight would be left, the corners keep theirs that
/// are visible from the heaviest one.
LAMBENT_FN CornerWeights tested_weights(CornerWeights before, uint hidden, uvec2 cell_visibility,
                                        float total) {
  CornerWeights corners = before;
  hide_corners(corners, hidden);
  if (scale_weights(corners, total) != 0) return corners;
  corners = before;
  hide_corners(corners, ~corners_seen_by(cell_visibility, heaviest_corner(before)));
  scale_weights(corners, total);
  return corners;
}

/// The corners with a weight above 0, as bits.
LAMBENT_FN uint weighed_corners(CornerWeights corners) {
  uint weighed = 0u;
  for (int k = 0; k < kCellCorners; ++k) {
    if (corners.weight[k] > 0.0f) weighed |= 1u << uint(k);
  }
  return weighed;
}

/// Exact visibility: the weight of a corner if a ray shows that it is visible. A corner of weight 0
/// needs no ray. `wrap` is 0 for probes inside geometry.
LAMBENT_FN float visible_weight(float trilinear, float wrap) {
  float cube = wrap * (wrap * wrap / (kCrushThreshold * kCrushThreshold));
  return trilinear * wrap > 0.0f ? trilinear * crushed_weight(wrap, cube) : 0.0f;
}

LAMBENT_END
#endif
