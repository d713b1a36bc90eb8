// SPDX-License-Identifier: Apache-2.0
// The light that a surface receives where it averages over bumps.
#ifndef LAMBENT_SHARED_BUMPS_H
#define LAMBENT_SHARED_BUMPS_H

#include "shared/constants.h"
#include "shared/lang.h"

LAMBENT_BEGIN

// The tail of the normal distribution beyond x standard deviations is exp(-x^2 / 2) times a
// polynomial in t = 1 / (1 + kTailScale x), within 1.3e-5. Abramowitz and Stegun, "Handbook of
// Mathematical Functions", 1964, Eq. 7.1.25.
const float kTailScale = 0.33267f;
const vec3 kTailPolynomial = vec3(0.1740121f, -0.0479399f, 0.3739278f);
// 1 / sqrt(2 pi): the density's factor.
const float kInvSqrt2Pi = 0.39894228f;

// Beyond this many standard deviations, the tail adds less than 0.0004 of one.
const float kMostDeviations = 3.0f;

/// Mean of max(0, n.l) over the normals n of the bumps that a surface averages over. `n_dot_l`: the
/// cosine of a light to their mean normal; below 0, some bumps still face the light. `length`:
/// length of the mean of their unit normals, 0 to 1; 1: there are no bumps, and the result is
/// `n_dot_l`. Slopes are taken to be normally distributed with the variance 1 - length along each
/// axis. Then n.l is, too, with the mean length * n_dot_l.
LAMBENT_FN float bumpy_cosine(float n_dot_l, float length) {
  if (length >= 1.0f) return n_dot_l;
  float mean = length * n_dot_l;
  float deviation = sqrt(max((1.0f - length) * (1.0f - n_dot_l * n_dot_l), 0.0f));
  if (abs(mean) >= kMostDeviations * deviation) return max(mean, 0.0f);
  float x = abs(mean) / deviation;
  float t = 1.0f / (1.0f + kTailScale * x);
  float tail = t * (kTailPolynomial.x + t * (kTailPolynomial.y + t * kTailPolynomial.z));
  return max(mean, 0.0f) + deviation * exp(-0.5f * x * x) * (kInvSqrt2Pi - x * tail);
}

LAMBENT_END
#endif
