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

// Of the probes that the heaviest corner of a cell does not see, those with a smaller weight than
// this count as hidden. Those with a larger weight are tested with a ray.
const float kMinTestedWeight = 0.05f;

/// A ray that is occluded where two points do not see each other.
LAMBENT_FN RayRecord visibility_ray(vec3 from_ws, vec3 to_ws) {
  vec3 way = to_ws - from_ws;
  float distance = max(length(way), kMinProbeDistance);
  RayRecord ray = {from_ws, 0.0f, way / distance, distance, kRayOfProbe};
  return ray;
}

/// The bit of a cell's visibility that says whether one corner sees another.
LAMBENT_FN int visibility_bit(int corner, int other) {
  return kCellCorners * corner + other;
}

/// The corner with the largest weight.
LAMBENT_FN int heaviest_corner(CornerWeights corners) {
  int heaviest = 0;
  for (int k = 1; k < kCellCorners; ++k) {
    if (corners.weight[k] > corners.weight[heaviest]) heaviest = k;
  }
  return heaviest;
}

LAMBENT_FN float sum_of_weights(CornerWeights corners) {
  float sum = 0.0f;
  for (int k = 0; k < kCellCorners; ++k) sum += corners.weight[k];
  return sum;
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

/// Hybrid visibility. `corners` has weights by distances with a sum of `total`. Bit k of `seen`
/// says whether the heaviest corner sees corner k.
LAMBENT_FN VisibilityMask visibility_mask(CornerWeights corners, uint seen, float total) {
  VisibilityMask mask = {0u, 0u};
  for (int k = 0; k < kCellCorners; ++k) {
    uint bit = 1u << uint(k);
    if ((seen & bit) != 0u || corners.weight[k] <= 0.0f) continue;
    if (corners.weight[k] < kMinTestedWeight * total) {
      mask.hidden |= bit;
    } else {
      mask.tested |= bit;
    }
  }
  return mask;
}

/// Exact visibility: the weight of a corner if it is visible. A corner of weight 0 needs no ray.
/// `wrap` is 0 for probes inside geometry.
LAMBENT_FN float seen_weight(float trilinear, float wrap) {
  return trilinear * wrap > 0.0f ? trilinear * combined_weight(wrap, 1.0f) : 0.0f;
}

LAMBENT_END
#endif
