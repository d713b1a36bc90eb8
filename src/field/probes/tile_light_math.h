// SPDX-License-Identifier: Apache-2.0
// The relative size of a difference between two tiles, and the likeness of their distributions.
#ifndef LAMBENT_FIELD_PROBES_TILE_LIGHT_MATH_H
#define LAMBENT_FIELD_PROBES_TILE_LIGHT_MATH_H

#include "shared/color.h"

LAMBENT_BEGIN

// Luminance below this counts as none [W/m^2]. Keeps divisions finite.
const float kTiniestLight = 1e-20f;

/// How much a probe's light changed in an update.
struct LightChange {
  float squares;  ///< Sum of the squared differences of luminance over the texels of its tile.
  float before;   ///< Mean luminance of the texels before the update.
  float now;      ///< Mean luminance after it.
};

/// The mean square of a difference, divided by the square of `mean`. `squares` is the sum of the
/// difference's squares over all texels.
LAMBENT_FN float mean_relative_square(float squares, int texels, float mean) {
  return squares / (float(texels) * max(mean * mean, kTiniestLight));
}

/// Sums over the texels of two tiles, from which likeness_of() computes their similarity.
struct LikenessSums {
  float intersection;
  float united;
};

/// Adds a texel of each of two tiles, whose mean luminances are given.
LAMBENT_FN LikenessSums add_likeness(LikenessSums sums, vec3 a, float mean_a, vec3 b,
                                     float mean_b) {
  if (mean_a <= kTiniestLight || mean_b <= kTiniestLight) return sums;
  vec3 x = a / mean_a;
  vec3 y = b / mean_b;
  sums.intersection += luminance(min(x, y));
  sums.united += luminance(max(x, y));
  return sums;
}

/// The similarity of two tiles' distributions of light over directions, 0 to 1, regardless of
/// brightness: the common part of both over their union.
LAMBENT_FN float likeness_of(LikenessSums sums, float mean_a, float mean_b) {
  if (mean_a <= kTiniestLight || mean_b <= kTiniestLight) return 0.0f;
  return max(sums.intersection, 0.0f) / sums.united;
}

LAMBENT_END
#endif
