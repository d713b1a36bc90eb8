// SPDX-License-Identifier: Apache-2.0
// Blending of moments of distances into a store.
#ifndef LAMBENT_FIELD_PROBES_MOMENTS_ENCODING_H
#define LAMBENT_FIELD_PROBES_MOMENTS_ENCODING_H

#include "shared/packing.h"
#include "shared/random.h"

LAMBENT_BEGIN

/// Blends stored moments with new ones. `now` is in metres; a metre is `scale` units of the store.
LAMBENT_FN vec2 blended_moments(vec2 old, vec2 now, float blend_weight, float scale) {
  return vec2(old.x + blend_weight * (scale * now.x - old.x),
              old.y + blend_weight * (scale * scale * now.y - old.y));
}

/// Blends moments that are stored as a word of two halves. `seed` is the seed of the dither.
LAMBENT_FN uint blended_halves(uint word, vec2 now, float blend_weight, float scale, uint seed) {
  vec2 old =
      vec2(decode_small_float(word & 0x7FFFu, 10), decode_small_float((word >> 16u) & 0x7FFFu, 10));
  vec2 moments = blended_moments(old, now, blend_weight, scale);
  uint bits = hash_pcg(seed);
  float u = float(bits & 0xFFFFu) * (1.0f / 65536.0f);
  float v = float(bits >> 16u) * (1.0f / 65536.0f);
  return encode_small_float(moments.x, 10, u) | (encode_small_float(moments.y, 10, v) << 16u);
}

/// Stored moments, shifted by the change in the moments of a probe's rays. Stored moments average
/// the rays of many updates, and a shift preserves what did not change. Where no distances can have
/// the result, because of rounding or noise, the rays' moments replace it. They also do where
/// `has_history` is false: distances from before a probe came out of geometry, or went into it, are
/// useless.
LAMBENT_FN vec2 shifted_moments(vec2 held, vec2 before, vec2 after, bool has_history) {
  if (!has_history) return after;
  if (before == after) return held;
  vec2 moved = held + after - before;
  return moved.x > 0.0f && moved.y >= moved.x * moved.x ? moved : after;
}

LAMBENT_END
#endif
