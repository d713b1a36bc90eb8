// SPDX-License-Identifier: Apache-2.0
// What the rays that gather a pixel's light (field/secondary/secondary_math.h) contribute to it.
#ifndef LAMBENT_GATHER_GATHER_MATH_H
#define LAMBENT_GATHER_GATHER_MATH_H

#include "field/secondary/secondary_math.h"
#include "shared/color.h"
#include "shared/pixel_points.h"
#include "shared/variance.h"

LAMBENT_BEGIN

// A ray that contributes this many times the irradiance that its pixel is known to have is so rare
// that the filter could not tell such a pixel from its neighbours by its light. The part above is
// stored as excess, and spread over the whole surface.
const float kBrightestRay = 32.0f;

/// Luminance of the irradiance that a pixel is known to have: that from a lookup of the field or,
/// where it is larger, the mean of the pixel's rays without the brightest. Where several rays bring
/// far more than the lookup, they are not rare. `sum`: that of the rays' luminances; `most`: the
/// largest of these.
LAMBENT_FN float known_level(vec3 looked_up, float sum, float most, uint count) {
  float level = luminance(looked_up);
  return count > 1u ? max(level, (sum - most) / float(count - 1u)) : level;
}

/// The part of a ray's contribution that its pixel keeps; the rest is excess. `known`:
/// known_level() of the pixel.
LAMBENT_FN vec3 kept_of_ray(vec3 brought, float known) {
  float most = kBrightestRay * known;
  float level = luminance(brought);
  return level > most ? brought * (most / level) : brought;
}

/// Sums over rays of a pixel that were drawn in one way.
struct RaySums {
  float luminances, squares;
};

LAMBENT_FN void add_ray(LAMBENT_INOUT(RaySums) sums, float luminance_of_ray) {
  sums.luminances += luminance_of_ray;
  sums.squares += luminance_of_ray * luminance_of_ray;
}

/// Variance of the sum of the luminances of a pixel's rays, of which so many are guided. These and
/// the others have means of their own, whose difference is no noise; it counts as such where either
/// kind is a single ray, whose variance is unknown.
LAMBENT_FN float variance_of_rays(RaySums guided, RaySums others, uint guided_count, uint count) {
  uint others_count = count - guided_count;
  if (guided_count <= 1u || others_count <= 1u) {
    return variance_of_sum(guided.luminances + others.luminances, guided.squares + others.squares,
                           count);
  }
  return variance_of_sum(guided.luminances, guided.squares, guided_count) +
         variance_of_sum(others.luminances, others.squares, others_count);
}

LAMBENT_END
#endif
