// SPDX-License-Identifier: Apache-2.0
// The parts of a probe's importance that its surfels scatter.
#ifndef LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H
#define LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H

#include "shared/color.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// Only one in this many of a probe's surfels scatters importance, for those around it as well.
const uint kSurfelsPerScatter = 4u;

/// The fraction of a probe's importance that each scattering surfel receives.
LAMBENT_FN float scatter_fraction(int surfels) {
  return float(kSurfelsPerScatter) / float(surfels);
}

/// The albedo with which a surfel scatters importance.
LAMBENT_FN float scatter_albedo(vec3 albedo_over_pi) {
  return kPi * luminance(albedo_over_pi);
}

LAMBENT_END
#endif
