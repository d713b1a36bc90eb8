// SPDX-License-Identifier: Apache-2.0
// The light that a surface receives where it averages over bumps.
#ifndef LAMBENT_SHARED_BUMPS_H
#define LAMBENT_SHARED_BUMPS_H

#include "shared/constants.h"
#include "shared/lang.h"

LAMBENT_BEGIN

// The integral of the normal distribution's tail over its density, Abramowitz and Stegun, "Handbook
// of Mathematical Functions", 1964, Eq. 7.1.25, for arguments in standard deviations. Its error is
// 2.5e-5 of the whole.
const float kTailScale = 0.33267f;
const vec3 kTailPolynomial = vec3(0.1740121f, -0.0479399f, 0.3739278f);
const float kInvSqrt2Pi = 0.39894228f;

// Beyond this many standard deviations, a normal distribution's tail adds less than 0.0004 of one.
const float kMostDeviations = 3.0f;

/// Mean of max(0, n.l) over the normals n of the bumps that a surface averages over, of a light
/// above the horizon of the bumps' mean normal, to which it has the cosine `n_dot_l` > 0. `length`
/// is that of the mean of the unit normals, 0 to 1; 1: of a surface without bumps. Their mean n.l
/// is length * n_dot_l. Slopes are taken to be normally distributed, with the variance 1 - length
/// along each axis, so n.l is, too; where the light is grazing, some bumps are turned from it, and
/// the mean of the others' n.l is larger.
LAMBENT_FN float bumpy_cosine(float n_dot_l, float length) {
  if (length >= 1.0f) return n_dot_l;
  float mean = length * n_dot_l;
  float deviation = sqrt(max((1.0f - length) * (1.0f - n_dot_l * n_dot_l), 0.0f));
  if (mean >= kMostDeviations * deviation) return mean;
  float x = mean / deviation;
  float t = 1.0f / (1.0f + kTailScale * x);
  float tail = t * (kTailPolynomial.x + t * (kTailPolynomial.y + t * kTailPolynomial.z));
  return mean + deviation * exp(-0.5f * x * x) * (kInvSqrt2Pi - x * tail);
}

LAMBENT_END
#endif
