// SPDX-License-Identifier: Apache-2.0
// Which of the eight probes around a point are asked for with rays, and what they weigh then.
#ifndef LAMBENT_FIELD_LOOKUP_VISIBILITY_MATH_H
#define LAMBENT_FIELD_LOOKUP_VISIBILITY_MATH_H

#include "field/lookup/lookup.h"
#include "field/lookup/lookup_records.h"
#include "raytracing/ray_records.h"

LAMBENT_BEGIN

// Pairs of probes of a cell.
const int kCellPairs = kCellCorners * (kCellCorners - 1) / 2;

// Where a probe's distances let so small a share through, and the probe that matters most does not
// see it, it is hidden; a larger share is worth a ray.
const float kMinTestedWeight = 0.05f;

/// A ray that meets something where the one point does not see the other.
LAMBENT_FN RayRecord visibility_ray(vec3 from_ws, vec3 to_ws) {
  vec3 way = to_ws - from_ws;
  float distance = max(length(way), kMinProbeDistance);
  RayRecord ray = {from_ws, 0.0f, way / distance, distance, kRayOfProbe};
  return ray;
}

/// In a cell's sights, the bit that says whether one corner sees another.
LAMBENT_FN int visibility_bit(int corner, int other) {
  return kCellCorners * corner + other;
}

/// The corner that counts most.
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

/// Scales weights to a sum of `share`. 0 where there are none.
LAMBENT_FN int scale_weights(LAMBENT_INOUT(CornerWeights) corners, float total) {
  float sum = sum_of_weights(corners);
  if (!(sum > 0.0f)) return 0;
  for (int k = 0; k < kCellCorners; ++k) {
    corners.weight[k] = corners.weight[k] / sum * total;
  }
  return 1;
}

/// Corners by their bits: those that count for nothing, and those worth a ray.
struct VisibilityMask {
  uint hidden;
  uint tested;
};

/// Hybrid visibility. `weights` are by distances, with a sum of `share`; bit k of `seen`: the
/// corner that counts most sees corner k.
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

/// Exact visibility: what a corner weighs if it is seen; 0: it need not be asked for. `wrap` is 0
/// for probes in solid matter.
LAMBENT_FN float seen_weight(float trilinear, float wrap) {
  return trilinear * wrap > 0.0f ? trilinear * combined_weight(wrap, 1.0f) : 0.0f;
}

LAMBENT_END
#endif
