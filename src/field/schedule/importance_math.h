// SPDX-License-Identifier: Apache-2.0
// The share of a probe's importance that each of its surfels scatters.
#ifndef LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H
#define LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H

#include "shared/color.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// One in this many of a probe's surfels scatters importance, with this many times its weight.
const uint kSurfelsPerScatter = 4u;

/// The importance that a scattering surfel passes on from a probe of importance `received`, which
/// has this many surfels.
LAMBENT_FN float scattered_importance(float received, int surfels, vec3 albedo_over_pi) {
  float fraction = float(kSurfelsPerScatter) / float(surfels);
  return received * fraction * (kPi * luminance(albedo_over_pi));
}

LAMBENT_END
#endif
