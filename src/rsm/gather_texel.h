// SPDX-License-Identifier: Apache-2.0
// The light of one texel at a point; gather_kernel.inl.h does the same for lanes of pixels.
#ifndef LAMBENT_RSM_GATHER_TEXEL_H
#define LAMBENT_RSM_GATHER_TEXEL_H

#include "rsm/geometry_term.h"
#include "rsm/records.h"
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

/// A texel as seen from a point. `inverse` is one over the fourth power of the softened distance
/// [1/m^4], or 0 where one is behind the other's plane.
struct TexelSight {
  vec3 to_texel;      ///< [m]
  float above_texel;  ///< Height of the point over the texel's plane [m].
  float above_point;  ///< Height of the texel over the point's plane [m].
  float inverse;
};

LAMBENT_FN TexelSight see_texel(vec3 position_ws, vec3 normal_ws, RsmTexelRecord texel) {
  vec3 to_texel = texel.position_ws - position_ws;
  float above_texel = -dot(texel.normal_ws, to_texel);
  float above_point = dot(normal_ws, to_texel);
  float square = dot(to_texel, to_texel) + texel.softening;
  float inverse = min(above_texel, above_point) > 0.0f ? 1.0f / (square * square) : 0.0f;
  TexelSight sight = {to_texel, above_texel, above_point, inverse};
  return sight;
}

/// Adds the light of a texel whose flux is over pi, by bounded_geometry_term().
LAMBENT_FN void gather_texel(LAMBENT_INOUT(TexelLight) sum, vec3 normal_ws, TexelSight sight,
                             RsmTexelRecord texel) {
  float compensation = softening_compensation(dot(normal_ws, texel.normal_ws));
  float numerator = sight.above_texel * sight.above_point + texel.softening * compensation;
  sum.light += texel.flux * (numerator * sight.inverse);
}

/// Adds the vector to a texel, weighted by its light.
LAMBENT_FN void gather_direction(LAMBENT_INOUT(TexelLight) sum, TexelSight sight,
                                 RsmTexelRecord texel) {
  sum.directions += sight.to_texel * (sight.above_texel * sight.inverse * luminance(texel.flux));
}

LAMBENT_END
#endif
