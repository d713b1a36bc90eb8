// SPDX-License-Identifier: Apache-2.0
// What the rays that gather a pixel's light (field/secondary/secondary_math.h) contribute to it.
#ifndef LAMBENT_GATHER_GATHER_MATH_H
#define LAMBENT_GATHER_GATHER_MATH_H

#include "field/secondary/secondary_math.h"
#include "shared/color.h"
#include "shared/pixel_points.h"

LAMBENT_BEGIN

// A ray that contributes this many times the irradiance that the field has at its pixel is so rare
// that the filter could not tell such a pixel from its neighbours by its light. The part above is
// stored as excess, and spread over the whole surface.
const float kBrightestRay = 32.0f;

/// The part of a ray's contribution that its pixel keeps; the rest is excess. `known`: the pixel's
/// irradiance from a lookup of the field.
LAMBENT_FN vec3 kept_of_ray(vec3 brought, vec3 known) {
  float most = kBrightestRay * luminance(known);
  float level = luminance(brought);
  return level > most ? brought * (most / level) : brought;
}

LAMBENT_END
#endif
