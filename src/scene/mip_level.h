// SPDX-License-Identifier: Apache-2.0
// The MIP level of a texture that a ray's cone reads (raytracing/ray_cone.h). After
// Akenine-Moeller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray
// Tracing Gems, 2019.
#ifndef LAMBENT_SCENE_MIP_LEVEL_H
#define LAMBENT_SCENE_MIP_LEVEL_H

#include "shared/lang.h"

LAMBENT_BEGIN

const uint kOneBits = 0x3F800000u;  // of 1.0

/// Cross section of a cone of this width over a triangle's area; 0 where there is no cone.
LAMBENT_FN float share_of_triangle(float footprint, float double_area) {
  if (footprint <= 0.0f || double_area <= 0.0f) return 0.0f;
  return 2.0f * footprint * footprint / double_area;
}

/// The number of a texture's texels that a cone covers (Eq. 2). The edges are those of the
/// triangle, in texture coordinates; `share_of_triangle` is the cone's cross section over the
/// triangle's area.
LAMBENT_FN float cone_texels(vec2 uv_edge1, vec2 uv_edge2, vec2 uv_scale, int width, int height,
                             float share_of_triangle) {
  float triangle_texels =
      0.5f * abs((uv_edge1.x * uv_edge2.y - uv_edge1.y * uv_edge2.x) * uv_scale.x * uv_scale.y) *
      float(width) * float(height);
  return triangle_texels * share_of_triangle;
}

/// The MIP level at which a cone covers about one texel: half the logarithm of cone_texels().
LAMBENT_FN int mip_level(vec2 uv_edge1, vec2 uv_edge2, vec2 uv_scale, int width, int height,
                         float share_of_triangle) {
  float texels = cone_texels(uv_edge1, uv_edge2, uv_scale, width, height, share_of_triangle);
  if (!(texels > 1.0f)) return 0;
  // round(log2(t) / 2) = floor(log2(2 t) / 2), and the exponent is the logarithm's floor
  return (int(floatBitsToUint(2.0f * texels) >> 23u) - 127) / 2;
}

/// The share of a triangle that a ray's cone covers, from which MIP levels are chosen.
struct ConeShare {
  float of_triangle;  ///< The cone's cross section over the triangle's area; 0: full resolution.
  uint blended;       ///< 1: texels and MIP levels are interpolated, for surfaces in view; 0: the
                      ///< nearest texel is enough, since many such rays are averaged.
};

LAMBENT_FN ConeShare full_resolution() {
  ConeShare none = {0.0f, 0u};
  return none;
}

/// mip_level() without rounding. The logarithm is approximated as linear between powers of two,
/// with an error of at most 0.05.
LAMBENT_FN float blended_level(vec2 uv_edge1, vec2 uv_edge2, vec2 uv_scale, int width, int height,
                               float share_of_triangle) {
  float texels = cone_texels(uv_edge1, uv_edge2, uv_scale, width, height, share_of_triangle);
  if (!(texels > 1.0f)) return 0.0f;
  const uint mantissa_bits = 0x007FFFFFu;
  uint bits = floatBitsToUint(texels);
  float mantissa = uintBitsToFloat((bits & mantissa_bits) | kOneBits);
  return 0.5f * (float(int(bits >> 23u) - 127) + (mantissa - 1.0f));
}

// Two levels are interpolated only over the middle half of the interval between them, so that half
// of all reads need a single level. The difference is not visible.
const float kLevelBlend = 2.0f;

/// Weight of the coarser of two levels, from the fractional part of the level.
LAMBENT_FN float level_share(float between) {
  return clamp((between - 0.5f) * kLevelBlend + 0.5f, 0.0f, 1.0f);
}

// From kMinMeanLevel on, details are averaged out; with at most kMaxLevelsToCoarsest coarser
// levels, the texture consists of only a few such averages.
const int kMinMeanLevel = 2;
const int kMaxLevelsToCoarsest = 4;

/// Whether a level of a texture is nearly uniform, and so close to the texture's mean.
LAMBENT_FN bool shows_mean_alone(int level, int coarsest) {
  return level >= kMinMeanLevel && coarsest - level <= kMaxLevelsToCoarsest;
}

LAMBENT_END
#endif
