// SPDX-License-Identifier: Apache-2.0
// Functions of the field that C++ and GLSL share, as a function from numbers to numbers.
#ifndef LAMBENT_TESTS_TWIN_FIELD_MATH_H
#define LAMBENT_TESTS_TWIN_FIELD_MATH_H

#include "field/placement/classify_math.h"
#include "field/probes/irradiance_encoding.h"
#include "field/probes/moments_encoding.h"
#include "field/probes/tile.h"
#include "field/schedule/schedule_math.h"
#include "field/transport/anderson_math.h"
#include "field/transport/blend_math.h"
#include "raytracing/ray_records.h"

LAMBENT_BEGIN

struct FieldMathArguments {
  FloatArray in_numbers;   ///< kFieldMathInputs per case, 0 to 1.
  FloatArray out_numbers;  ///< kFieldMathOutputs per case.
  uint count;
  uint padding;
};

const int kFieldMathInputs = 16;
const int kFieldMathExact = 11;    // the first outputs, which must agree to the bit
const int kFieldMathOutputs = 26;  // all outputs; the others must agree up to rounding

struct FieldMathResult {
  float number[kFieldMathOutputs];
};

/// The Gram matrix of three random steps, and their products with a residual.
LAMBENT_FN StepProducts some_products(vec3 a, vec3 b, vec3 c, vec3 residual) {
  vec3 steps[3];
  steps[0] = a;
  steps[1] = b;
  steps[2] = c;
  StepProducts products;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      products.gram[3 * i + j] = make_wide(0.0f);
      for (int k = 0; k < 3; ++k) {
        products.gram[3 * i + j] =
            wide_add(products.gram[3 * i + j], exact_product(steps[i][k], steps[j][k]));
      }
    }
    products.projection[i] = make_wide(0.0f);
    for (int k = 0; k < 3; ++k) {
      products.projection[i] =
          wide_add(products.projection[i], exact_product(steps[i][k], residual[k]));
    }
  }
  return products;
}

LAMBENT_FN FieldMathResult field_math(vec4 a, vec4 b, vec4 c, vec4 d) {
  FieldMathResult r;
  Wide sum = exact_sum(a.x, 1e-4f * a.y);
  Wide product = exact_product(a.z, a.w);
  Wide quotient = wide_divide(sum, make_wide(0.5f + b.x));
  r.number[0] = sum.high;
  r.number[1] = sum.low;
  r.number[2] = product.high;
  r.number[3] = product.low;
  ivec2 gutter = gutter_texel(int(b.y * 36.0f), 8);
  r.number[4] = float(gutter.x);
  r.number[5] = float(gutter.y);
  r.number[6] = float(is_inside_geometry(int(b.z * 20.0f), 40));
  r.number[7] = counted_distance(3.0f * b.w, a.x < 0.5f ? 1u : 0u, 2.0f);
  vec3 dither = irradiance_dither(uint(a.x * 1000.0f), 7u);
  r.number[8] = dither.x;
  r.number[9] = dither.y;
  r.number[10] = dither.z;

  r.number[11] = quotient.high;
  vec3 coefficients = step_coefficients(some_products(vec3(a), vec3(b), vec3(c), vec3(d)), 3);
  r.number[12] = coefficients.x;
  r.number[13] = coefficients.y;
  r.number[14] = coefficients.z;
  r.number[15] = ray_weight(normalize(vec3(a)), normalize(vec3(b)), 1.0f);
  r.number[16] = ray_weight(normalize(vec3(c)), normalize(vec3(d)), kDistanceExponent);
  r.number[17] = remaining_error(assumed_contraction(c.w, 0.9f * b.x), d.w, a.x);
  VarianceEstimate known = {2.0f * a.x, uint(40.0f * a.y)};
  known = learned_variance(known, 3.0f * a.z, 0.2f + a.w, b.x < 0.1f ? 0.0f : 20.0f * b.y);
  r.number[18] = known.variance;
  r.number[19] = float(known.samples);
  LightChange change = {c.x, c.y, 0.0f};
  r.number[20] = estimate_relative_square(change, 16, 0.05f + c.z, c.w < 0.1f ? 0.0f : 3.0f * c.w);
  r.number[24] = probe_urgency(a.x, uint(b.x * 300.0f), 300u, b.y);
  r.number[25] = history_blend_weight(40.0f * a.y, 0.1f + c.x, 25.0f);
  r.number[21] = learned_light(d.x, d.y, 64.0f * d.z, 100.0f * d.w);
  r.number[22] = error_reduction(probe_deviation(0.2f * a.x, 0.2f * b.x), 30.0f * c.x, 25.0f);
  r.number[23] = error_reduction_per_deviation(d.z);
  return r;
}

LAMBENT_END
#endif
