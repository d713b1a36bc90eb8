// SPDX-License-Identifier: Apache-2.0
// Sums the light of texels at a point; gather_kernel.inl.h does so for lanes of pixels.
#ifndef LAMBENT_RSM_GATHER_TEXEL_H
#define LAMBENT_RSM_GATHER_TEXEL_H

#include "rsm/records.h"
#include "rsm/texel_light.h"
#include "shared/color.h"

LAMBENT_BEGIN

/// The vectors to texels are summed for every kTexelsPerDirection-th texel, which is enough for a
/// mean. Raising it saves up to a twentieth of a gather: a vector costs a third more than a texel
/// alone.
const int kTexelsPerDirection = 8;

/// Light gathered at a point, and its mean direction.
struct TexelLight {
  vec3 light;       ///< Irradiance [W/m^2].
  vec3 directions;  ///< Sum of vectors to texels, weighted by their luminance; of any length.
};

LAMBENT_FN TexelSight see_texel_record(vec3 position_ws, vec3 normal_ws, RsmTexelRecord texel) {
  return see_texel(point_numbers(position_ws, normal_ws),
                   texel_numbers(texel.position_ws, texel.normal_ws, texel.softening));
}

/// Adds the light of a texel whose flux is over pi, by bounded_geometry_term().
LAMBENT_FN void gather_texel(LAMBENT_INOUT(TexelLight) sum, TexelSight sight,
                             RsmTexelRecord texel) {
  sum.light += texel.flux * (sight.numerator * sight.inverse);
}

/// Adds the vector to a texel, weighted by its light.
LAMBENT_FN void gather_direction(LAMBENT_INOUT(TexelLight) sum, TexelSight sight,
                                 RsmTexelRecord texel) {
  sum.directions +=
      vec3(sight.x, sight.y, sight.z) * (sight.above_texel * sight.inverse * luminance(texel.flux));
}

LAMBENT_END
#endif
