// SPDX-License-Identifier: Apache-2.0
// Based on: Eisemann and Durand, "Flash Photography Enhancement via Intrinsic Relighting", SIGGRAPH
// 2004 (cross, or joint, bilateral filter). Weights of neighbouring pixels in a blur that preserves
// the edges of surfaces.
#ifndef LAMBENT_SHARED_CROSS_BILATERAL_H
#define LAMBENT_SHARED_CROSS_BILATERAL_H

#include "shared/reorient_irradiance.h"

LAMBENT_BEGIN

// The guide: quantities that tell a pixel's surface from its neighbours', as planes of single
// numbers: position x, y, z [m]; normal x, y, z, unit, 0 where nothing is seen; one over depth
// [1/m].
const int kPositionPlane = 0;
const int kNormalPlane = 3;
const int kInverseDepthPlane = 6;
const int kGuidePlanes = 7;

/// Weight, 0 to 1, of a neighbour in the filtered light of a pixel, when the light is then adapted
/// to the pixel's normal (shared/reorient_irradiance.h). `offset` leads from one point to the
/// other; `inverse_tolerance` is one over the distance [1/m] from the plane of `normal` at which
/// the weight is 0. The distance from the plane is used, not depth alone, since a floor seen at a
/// grazing angle is one surface. The 16th power of the cosine halves the weight at 17 degrees,
/// which includes bumps but excludes other surfaces. Pixels that show no surface have a normal of 0
/// and no weight.
LAMBENT_FN float relit_bilateral_weight(vec3 offset, vec3 normal, vec3 other_normal,
                                        float inverse_tolerance) {
  return relit_weight(dot(normal, other_normal), dot(normal, offset) * inverse_tolerance);
}

/// The weight when the light is not adapted to the pixel's normal. The 48th power of the cosine
/// halves the weight at 10 degrees, since light on bumps differs that much.
LAMBENT_FN float cross_bilateral_weight(vec3 offset, vec3 normal, vec3 other_normal,
                                        float inverse_tolerance) {
  float cosine = max(0.0f, dot(normal, other_normal));
  float square = cosine * cosine;
  float sixteenth = (square * square) * (square * square);
  sixteenth *= sixteenth;
  return (sixteenth * sixteenth) *
         relit_bilateral_weight(offset, normal, other_normal, inverse_tolerance);
}

LAMBENT_END
#endif
