// SPDX-License-Identifier: Apache-2.0
// Blending of moments into a store. The includer has declared push constants with members
// `args.store` and `args.dither_seed`.
#ifndef LAMBENT_FIELD_PROBES_SHADERS_STORE_MOMENTS_GLSL
#define LAMBENT_FIELD_PROBES_SHADERS_STORE_MOMENTS_GLSL

#include "field/probes/moments_encoding.h"
#include "field/probes/shaders/store.glsl"

/// Blends a stored texel with new moments [m, m^2]. A metre is `scale` units of the store.
void store_moments(int texel, vec2 now, float blend_weight, float scale) {
  if (kDistanceFormat == kRg16f) {
    args.store.distance.at[texel] = blended_halves(args.store.distance.at[texel], now, blend_weight,
                                                   scale, uint(texel) + args.dither_seed);
    return;
  }
  vec2 moments = blended_moments(moments_at(texel), now, blend_weight, scale);
  args.store.distance.at[2 * texel] = floatBitsToUint(moments.x);
  args.store.distance.at[2 * texel + 1] = floatBitsToUint(moments.y);
}

#endif
