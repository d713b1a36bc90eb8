// SPDX-License-Identifier: Apache-2.0
// Variance of light, from the samples of which it is the sum.
#ifndef LAMBENT_SHARED_VARIANCE_H
#define LAMBENT_SHARED_VARIANCE_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Variance of the sum of `count` (>= 2) numbers that were drawn independently, from that sum and
/// the sum of their squares.
LAMBENT_FN float variance_of_sum(float sum, float squares, uint count) {
  float n = float(count);
  return max(squares - sum * sum / n, 0.0f) * n / (n - 1.0f);
}

LAMBENT_END
#endif
