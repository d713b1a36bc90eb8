// SPDX-License-Identifier: Apache-2.0
// What the mean of a normal map's vectors tells of the bumps that it stands for.
#ifndef LAMBENT_SHARED_BUMPS_H
#define LAMBENT_SHARED_BUMPS_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Maps have 8 bits a component: means of equal normals are shorter than 1 by up to this rounding.
const float kLengthRounding = 1.0f / 255.0f;

/// Variance of the slopes, along each axis, of bumps whose unit normals have a mean of this length:
/// for small slopes p it is shorter than 1 by the mean of |p|^2 / 2.
LAMBENT_FN float variance_of_slopes(float mean_length) {
  return max(1.0f - kLengthRounding - mean_length, 0.0f);
}

LAMBENT_END
#endif
