// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019 (perceptual encoding). Theirs averages in the encoded domain; ours
// averages linear light and encodes only to store. The default encoding, RGB9E5, is in
// shared/packing.h.
#ifndef LAMBENT_FIELD_PROBES_IRRADIANCE_ENCODING_H
#define LAMBENT_FIELD_PROBES_IRRADIANCE_ENCODING_H

#include "shared/packing.h"
#include "shared/random.h"

LAMBENT_BEGIN

// Irradiance is stored to the power of 1/5, so that the few bits of R11G11B10F give steps that are
// about equally visible at all levels.
LAMBENT_FN float perceptual_from_linear(float linear) {
  return pow(linear, 0.2f);
}
LAMBENT_FN float linear_from_perceptual(float encoded) {
  float squared = encoded * encoded;
  return squared * squared * encoded;
}

/// The code of one channel. Chooses between the two codes around `linear` with the probabilities
/// for which the mean of the *decoded* light is `linear`. `u` is uniform in [0, 1).
LAMBENT_FN uint encode_perceptual_channel(float linear, int mantissa_bits, float u) {
  uint down = encode_small_float_down(perceptual_from_linear(max(linear, 0.0f)), mantissa_bits);
  uint up = next_small_float(down, mantissa_bits);
  float low = linear_from_perceptual(decode_small_float(down, mantissa_bits));
  float high = linear_from_perceptual(decode_small_float(up, mantissa_bits));
  return linear - low > u * (high - low) ? up : down;
}

LAMBENT_FN uint encode_r11g11b10f(vec3 irradiance, vec3 u) {
  return encode_perceptual_channel(irradiance.x, 6, u.x) |
         (encode_perceptual_channel(irradiance.y, 6, u.y) << 11u) |
         (encode_perceptual_channel(irradiance.z, 5, u.z) << 22u);
}

/// The random numbers with which a texel is stored. `index` is the texel's index in the store.
/// Random numbers of fewer bits would bias R11G11B10F, whose steps are wide, by some per mille.
LAMBENT_FN vec3 irradiance_dither(uint index, uint dither_seed) {
  uvec3 bits = hash_pcg3d(uvec3(index, dither_seed, 0u));
  return vec3(uniform_from_bits(bits.x), uniform_from_bits(bits.y), uniform_from_bits(bits.z));
}

LAMBENT_FN vec3 decode_r11g11b10f(uint word) {
  return vec3(linear_from_perceptual(decode_small_float(word & 0x7FFu, 6)),
              linear_from_perceptual(decode_small_float((word >> 11u) & 0x7FFu, 6)),
              linear_from_perceptual(decode_small_float(word >> 22u, 5)));
}

// The formats of irradiance, and the number of formats. The values are those of IrradianceFormat
// and of field files.
const uint kRgb9e5 = 0u;
const uint kR11g11b10f = 1u;
const uint kIrradianceFloat32 = 2u;
const uint kIrradianceFormatCount = 3u;

/// The number of 32-bit words of a texel: one, or three floats that hold the light unencoded.
LAMBENT_FN int words_of_irradiance(uint format) {
  return format == kIrradianceFloat32 ? 3 : 1;
}

/// The word of a texel in a format that takes one.
LAMBENT_FN uint encode_irradiance(uint format, vec3 irradiance, vec3 u) {
  if (format == kR11g11b10f) return encode_r11g11b10f(irradiance, u);
  return encode_rgb9e5(irradiance, u);
}

/// The light of a texel in a format that takes one word.
LAMBENT_FN vec3 decode_irradiance(uint format, uint word) {
  if (format == kR11g11b10f) return decode_r11g11b10f(word);
  return decode_rgb9e5(word);
}

LAMBENT_END
#endif
