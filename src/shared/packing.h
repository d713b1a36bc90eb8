// SPDX-License-Identifier: Apache-2.0
// Small number formats, each as encode and decode. Encoders take a uniform random number per
// channel and round up or down with the probability that makes the decoded value right on average
// (dither), so that a value stored again and again neither stalls nor drifts; 0.5 everywhere rounds
// to nearest.
#ifndef LAMBENT_SHARED_PACKING_H
#define LAMBENT_SHARED_PACKING_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Unsigned floats with 5 exponent bits (bias 15) and 5 to 10 mantissa bits: the channels of
// R11G11B10F and, without its sign, of a half. Numbers below the smallest normal one, 2^-14, are
// stored as 0 or as 2^-14.
const float kSmallFloatMin = 6.103515625e-05f;
const uint kSmallFloatBiasShift = 112u;  // 127 - 15, between the exponent biases

const int kFloatBias = 127;  // of a float's exponent, which starts at bit 23

/// 2 to an integer power, -126 to 127, exactly.
LAMBENT_FN float power_of_two(int exponent) {
  return uintBitsToFloat(uint(exponent + kFloatBias) << 23u);
}

/// Largest finite value with that many mantissa bits.
LAMBENT_FN float small_float_max(int mantissa_bits) {
  return 65536.0f * (1.0f - 0.5f * power_of_two(-mantissa_bits));
}

LAMBENT_FN float decode_small_float(uint bits, int mantissa_bits) {
  float value = uintBitsToFloat((bits << uint(23 - mantissa_bits)) + (kSmallFloatBiasShift << 23u));
  return bits == 0u ? 0.0f : value;
}

/// The largest code whose value is not above `value`, which is clamped to [0, max]; 0 for what is
/// not a number.
LAMBENT_FN uint encode_small_float_down(float value, int mantissa_bits) {
  float clamped = min(value, small_float_max(mantissa_bits));
  uint code =
      (floatBitsToUint(clamped) - (kSmallFloatBiasShift << 23u)) >> uint(23 - mantissa_bits);
  return value >= kSmallFloatMin ? code : 0u;
}

/// The code after `code`, in order of value; the largest follows itself.
LAMBENT_FN uint next_small_float(uint code, int mantissa_bits) {
  uint last = (31u << uint(mantissa_bits)) - 1u;
  uint next = code < last ? code + 1u : last;
  return code == 0u ? 1u << uint(mantissa_bits) : next;
}

/// Code of a value, dithered by `u` in [0, 1).
LAMBENT_FN uint encode_small_float(float value, int mantissa_bits, float u) {
  uint down = encode_small_float_down(value, mantissa_bits);
  uint up = next_small_float(down, mantissa_bits);
  float low = decode_small_float(down, mantissa_bits);
  float step = decode_small_float(up, mantissa_bits) - low;
  return value - low > u * step ? up : down;
}

/// Two halves in a word, for numbers >= 0.
LAMBENT_FN uint encode_half2(vec2 value, vec2 u) {
  return encode_small_float(value.x, 10, u.x) | (encode_small_float(value.y, 10, u.y) << 16u);
}

LAMBENT_FN vec2 decode_half2(uint word) {
  return vec2(decode_small_float(word & 0x7FFFu, 10),
              decode_small_float((word >> 16u) & 0x7FFFu, 10));
}

// RGB9E5: three 9-bit mantissas under one 5-bit exponent (bias 15), as in
// EXT_texture_shared_exponent.
const float kRgb9e5Max = 65408.0f;
const float kRgb9e5MantissaMax = 511.0f;
const int kRgb9e5BiasAndBits = 24;  // exponent bias 15 + 9 mantissa bits

LAMBENT_FN vec3 decode_rgb9e5(uint word) {
  float scale = power_of_two(int(word >> 27u) - kRgb9e5BiasAndBits);
  // Signed, because processors before AVX-512 convert only signed integers in vectors
  ivec3 mantissas = ivec3(int(word & 511u), int((word >> 9u) & 511u), int((word >> 18u) & 511u));
  return vec3(mantissas) * scale;
}

/// A channel as encode_rgb9e5 takes it: clamped to what can be stored; 0 for what is not a number.
LAMBENT_FN float storable_in_rgb9e5(float value) {
  return value > 0.0f ? min(value, kRgb9e5Max) : 0.0f;
}

LAMBENT_FN uint encode_rgb9e5(vec3 value, vec3 u) {
  vec3 v =
      vec3(storable_in_rgb9e5(value.x), storable_in_rgb9e5(value.y), storable_in_rgb9e5(value.z));
  float largest = max(v.x, max(v.y, v.z));
  // The exponent of the largest channel, read off its bits; one more where rounding up would
  // overflow 9 bits.
  int exponent = max(int(floatBitsToUint(largest) >> 23u) - kFloatBias, -16) + 16;
  if (largest > kRgb9e5MantissaMax * power_of_two(exponent - kRgb9e5BiasAndBits)) exponent += 1;
  exponent = min(exponent, 31);
  float per_step = power_of_two(kRgb9e5BiasAndBits - exponent);
  vec3 q = min(floor(v * per_step + u), vec3(kRgb9e5MantissaMax));
  return uint(q.x) | (uint(q.y) << 9u) | (uint(q.z) << 18u) | (uint(exponent) << 27u);
}

// Two floats in a word: the upper half of each, with 8 bits of precision.
const uint kUpperHalf = 0xFFFF0000u;
const uint kHalfOfLowerHalf = 0x8000u;
const uint kHalfBits = 16u;

/// Packs two finite floats, each rounded to nearest.
LAMBENT_FN uint pack_upper_halves(float upper, float lower) {
  return ((floatBitsToUint(upper) + kHalfOfLowerHalf) & kUpperHalf) |
         ((floatBitsToUint(lower) + kHalfOfLowerHalf) >> kHalfBits);
}

LAMBENT_FN float unpack_upper_half(uint word) {
  return uintBitsToFloat(word & kUpperHalf);
}

LAMBENT_FN float unpack_lower_half(uint word) {
  return uintBitsToFloat(word << kHalfBits);
}

LAMBENT_END
#endif
