// SPDX-License-Identifier: Apache-2.0
// Double-float numbers with twice a float's precision, for sums and small linear systems on devices
// without doubles.
// Based on: Dekker, "A Floating-Point Technique for Extending the Available Precision", Numerische
// Mathematik 18, 1971; Knuth, "The Art of Computer Programming", vol. 2, sec. 4.2.2.
#ifndef LAMBENT_SHARED_WIDE_H
#define LAMBENT_SHARED_WIDE_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// The number high + low, where low is the rounding error of high.
struct Wide {
  float high;
  float low;
};

LAMBENT_FN Wide make_wide(float value) {
  Wide wide = {value, 0.0f};
  return wide;
}

/// The rounded sum a + b and its rounding error, for |a| >= |b|.
LAMBENT_FN Wide ordered_sum(float a, float b) {
  LAMBENT_PRECISE float sum = a + b;
  LAMBENT_PRECISE float taken = sum - a;
  LAMBENT_PRECISE float lost = b - taken;
  Wide wide = {sum, lost};
  return wide;
}

/// The rounded sum a + b and its rounding error, for any a and b.
LAMBENT_FN Wide exact_sum(float a, float b) {
  LAMBENT_PRECISE float sum = a + b;
  LAMBENT_PRECISE float b_taken = sum - a;
  LAMBENT_PRECISE float a_taken = sum - b_taken;
  LAMBENT_PRECISE float a_lost = a - a_taken;
  LAMBENT_PRECISE float b_lost = b - b_taken;
  LAMBENT_PRECISE float lost = a_lost + b_lost;
  Wide wide = {sum, lost};
  return wide;
}

/// A float as the sum of two with half as many bits.
LAMBENT_FN Wide split_in_halves(float a) {
  LAMBENT_PRECISE float scaled = 4097.0f * a;  // 2^12 + 1
  LAMBENT_PRECISE float beyond = scaled - a;
  LAMBENT_PRECISE float high = scaled - beyond;
  LAMBENT_PRECISE float low = a - high;
  Wide halves = {high, low};
  return halves;
}

/// The rounded product a * b and its rounding error.
LAMBENT_FN Wide exact_product(float a, float b) {
  Wide x = split_in_halves(a);
  Wide y = split_in_halves(b);
  LAMBENT_PRECISE float product = a * b;
  LAMBENT_PRECISE float hh = x.high * y.high;
  LAMBENT_PRECISE float hl = x.high * y.low;
  LAMBENT_PRECISE float lh = x.low * y.high;
  LAMBENT_PRECISE float ll = x.low * y.low;
  LAMBENT_PRECISE float first = hh - product;
  LAMBENT_PRECISE float second = first + hl;
  LAMBENT_PRECISE float third = second + lh;
  LAMBENT_PRECISE float lost = third + ll;
  Wide wide = {product, lost};
  return wide;
}

LAMBENT_FN Wide wide_add(Wide a, Wide b) {
  Wide sum = exact_sum(a.high, b.high);
  LAMBENT_PRECISE float low = a.low + b.low;
  LAMBENT_PRECISE float lost = sum.low + low;
  return ordered_sum(sum.high, lost);
}

LAMBENT_FN Wide wide_multiply(Wide a, Wide b) {
  Wide product = exact_product(a.high, b.high);
  LAMBENT_PRECISE float first = a.high * b.low;
  LAMBENT_PRECISE float second = a.low * b.high;
  LAMBENT_PRECISE float cross_terms = first + second;
  LAMBENT_PRECISE float lost = product.low + cross_terms;
  return ordered_sum(product.high, lost);
}

LAMBENT_FN Wide wide_negate(Wide a) {
  Wide negated = {-a.high, -a.low};
  return negated;
}

/// a / b: the quotient of the high parts, plus that of the remainder.
LAMBENT_FN Wide wide_divide(Wide a, Wide b) {
  LAMBENT_PRECISE float first = a.high / b.high;
  Wide left = wide_add(a, wide_negate(wide_multiply(b, make_wide(first))));
  LAMBENT_PRECISE float second = left.high / b.high;
  return ordered_sum(first, second);
}

LAMBENT_END
#endif
