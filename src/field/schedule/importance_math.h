// SPDX-License-Identifier: Apache-2.0
// The parts of a probe's importance that its surfels scatter.
#ifndef LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H
#define LAMBENT_FIELD_SCHEDULE_IMPORTANCE_MATH_H

#include "shared/color.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// Only one in this many of a probe's surfels scatters importance, for those around it as well.
const uint kSurfelsPerScatter = 4u;

/// What each scattering surfel passes on of a probe's importance, where the probe has this many
/// surfels.
LAMBENT_FN float scattered_importance(float received, int surfels, vec3 albedo_over_pi) {
  float fraction = float(kSurfelsPerScatter) / float(surfels);
  return received * fraction * (kPi * luminance(albedo_over_pi));
}

LAMBENT_END
#endif
