// SPDX-License-Identifier: Apache-2.0
// What surfels take of a probe's importance.
#ifndef LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H
#define LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H

#include "shared/color.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// One in so many of a probe's surfels stands for those around it.
const uint kSurfelsPerScatter = 4u;

/// Share of a probe's importance that goes to each surfel that stands for others.
LAMBENT_FN float scatter_fraction(int surfels) {
  return float(kSurfelsPerScatter) / float(surfels);
}

/// What a surfel makes of it.
LAMBENT_FN float scatter_albedo(vec3 albedo_over_pi) {
  return kPi * luminance(albedo_over_pi);
}

LAMBENT_END
#endif
