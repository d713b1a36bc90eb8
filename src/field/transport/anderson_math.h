// SPDX-License-Identifier: Apache-2.0
// The decisions of an accelerated fixed-point iteration, shared by the processor and devices.
// Walker and Ni, "Anderson Acceleration for Fixed-Point Iterations", SIAM J. Numer. Anal. 49(4),
// 2011.
#ifndef LAMBENT_FIELD_TRANSPORT_ANDERSON_MATH_H
#define LAMBENT_FIELD_TRANSPORT_ANDERSON_MATH_H

#include "shared/wide.h"

LAMBENT_BEGIN

// The number of steps from which the iteration extrapolates. More steps help little and cost
// memory.
const int kAndersonDepth = 3;

// Regularises the small linear system for steps that are almost parallel, relative to the largest
// squared step.
const float kAndersonRidge = 1e-10f;

// The error estimate never assumes faster convergence than this contraction, whatever two steps
// suggest.
const float kMinContraction = 0.1f;

/// The contraction factor to assume for a transport: `observed` is the largest factor that its
/// iteration has shown, and `bound` an upper bound.
LAMBENT_FN float assumed_contraction(float observed, float bound) {
  return min(bound, max(observed, kMinContraction));
}

/// The estimated relative error of the light after blending in a solution. A contraction by q
/// leaves q / (1 - q) of the last step to go. `relative_residual` is the norm of the residual over
/// that of the image.
LAMBENT_FN float remaining_error(float contraction, float blend_weight, float relative_residual) {
  return blend_weight * (contraction / (1.0f - contraction)) * relative_residual;
}

/// The inner products of the last steps' residual changes with each other (row after row), and with
/// the residual.
struct StepProducts {
  Wide gram[9];
  Wide projection[3];
};

/// The coefficients with which the last steps are subtracted: solves gram * coefficients =
/// projection by Gaussian elimination. It needs no pivoting, because the Gram matrix with its ridge
/// is symmetric and positive definite.
LAMBENT_FN vec3 step_coefficients(StepProducts products, int steps) {
  float largest = 0.0f;
  for (int i = 0; i < steps; ++i) largest = max(largest, products.gram[4 * i].high);
  if (largest <= 0.0f) return vec3(0.0f);
  Wide ridge = exact_product(kAndersonRidge, largest);
  for (int i = 0; i < steps; ++i) products.gram[4 * i] = wide_add(products.gram[4 * i], ridge);
  for (int i = 0; i < steps; ++i) {
    for (int j = i + 1; j < steps; ++j) {
      Wide factor = wide_negate(wide_divide(products.gram[3 * j + i], products.gram[4 * i]));
      for (int k = i; k < steps; ++k) {
        products.gram[3 * j + k] =
            wide_add(products.gram[3 * j + k], wide_multiply(factor, products.gram[3 * i + k]));
      }
      products.projection[j] =
          wide_add(products.projection[j], wide_multiply(factor, products.projection[i]));
    }
  }
  vec3 coefficients = vec3(0.0f);
  for (int i = steps - 1; i >= 0; --i) {
    for (int j = i + 1; j < steps; ++j) {
      products.projection[i] =
          wide_add(products.projection[i],
                   wide_negate(wide_multiply(products.gram[3 * i + j], products.projection[j])));
    }
    products.projection[i] = wide_divide(products.projection[i], products.gram[4 * i]);
    coefficients[i] = products.projection[i].high;
  }
  return coefficients;
}

LAMBENT_END
#endif
