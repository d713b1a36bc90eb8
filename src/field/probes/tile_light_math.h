// SPDX-License-Identifier: Apache-2.0
// The relative size of a difference between two tiles.
#ifndef LAMBENT_FIELD_PROBES_TILE_LIGHT_MATH_H
#define LAMBENT_FIELD_PROBES_TILE_LIGHT_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Luminance below this counts as none [W/m^2]. Keeps divisions finite.
const float kTiniestLight = 1e-20f;

/// How much a probe's light changed in an update.
struct LightChange {
  float squares;  ///< Sum of the squared differences of luminance over the texels of its tile.
  float before;   ///< Mean luminance of the texels before the update.
  float now;      ///< Mean luminance after it.
};

/// The mean square of a difference over the square of `mean`, from the sum of its squares over all
/// texels.
LAMBENT_FN float mean_relative_square(float squares, int texels, float mean) {
  return squares / (float(texels) * max(mean * mean, kTiniestLight));
}

LAMBENT_END
#endif
