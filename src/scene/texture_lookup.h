// SPDX-License-Identifier: Apache-2.0
// The texels and MIP levels that a texture coordinate and a footprint read.
#ifndef LAMBENT_SCENE_TEXTURE_LOOKUP_H
#define LAMBENT_SCENE_TEXTURE_LOOKUP_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// The values of Wrap in scene.h.
const uint kWrapRepeat = 0u;
const uint kWrapMirroredRepeat = 1u;
const uint kWrapClampToEdge = 2u;

/// Scale, then rotation counter-clockwise as seen with v pointing down (`rotation`: its cosine and
/// sine), then offset. KHR_texture_transform.
LAMBENT_FN vec2 transform_uv(vec2 uv, vec2 scale, vec2 rotation, vec2 offset) {
  uv *= scale;
  if (rotation.x != 1.0f || rotation.y != 0.0f) {
    uv = vec2(rotation.x * uv.x + rotation.y * uv.y, -rotation.y * uv.x + rotation.x * uv.y);
  }
  return uv + offset;
}

const float kAllFloatsAreIntegers = 8388608.0f;  // from 2^23 on
const uint kFloatExponentMask = 0x7F800000u;
const uint kOneBits = 0x3F800000u;  // of 1.0

/// std::floor is a function call on a baseline processor, hence this one.
LAMBENT_FN float fast_floor(float value) {
  if (!(abs(value) < kAllFloatsAreIntegers)) return value;
  float truncated = float(int(value));
  return truncated > value ? truncated - 1.0f : truncated;
}

/// Texture coordinate wrapped to [0, 1], or to [0, 2] for kWrapMirroredRepeat, so that texel
/// indices are at most one outside the texture; 0 where it is not finite.
LAMBENT_FN float wrap_coordinate(float u, uint wrap) {
  if ((floatBitsToUint(u) & kFloatExponentMask) == kFloatExponentMask) return 0.0f;
  if (wrap == kWrapRepeat) return u - fast_floor(u);
  if (wrap == kWrapClampToEdge) return clamp(u, 0.0f, 1.0f);
  return u - 2.0f * fast_floor(0.5f * u);
}

/// Texel index after wrapping, without a division, for indices from wrap_coordinate and those one
/// off.
LAMBENT_FN int wrap_index(int i, int size, uint wrap) {
  if (wrap == kWrapRepeat) {
    if (i < 0) return i + size;
    return i < size ? i : i - size;
  }
  if (wrap == kWrapMirroredRepeat) {
    if (i < 0) i = -1 - i;
    if (i >= 2 * size) i -= 2 * size;
    if (i >= size) i = 2 * size - 1 - i;
  }
  return clamp(i, 0, size - 1);
}

/// The texel at a wrapped coordinate, along one axis.
LAMBENT_FN int nearest_index(float wrapped, int size, uint wrap) {
  return wrap_index(int(wrapped * float(size)), size, wrap);
}

/// The two texels whose centres are around a wrapped coordinate, along one axis, and the second's
/// share.
struct TexelPair {
  int first;
  int second;
  float fraction;
};

LAMBENT_FN TexelPair texels_around(float wrapped, int size, uint wrap) {
  float x = wrapped * float(size);
  float left = fast_floor(x - 0.5f);
  TexelPair pair = {wrap_index(int(left), size, wrap), wrap_index(int(left) + 1, size, wrap),
                    x - 0.5f - left};
  return pair;
}

/// The MIP level at which a cone covers about one texel: half the logarithm of the texels it
/// covers. After Akenine-Moeller et al., "Texture Level of Detail Strategies for Real-Time Ray
/// Tracing", Ray Tracing Gems, 2019, Eq. 2. The edges are those of the triangle, in texture
/// coordinates, `share_of_triangle` is the cone's cross section over the triangle's area.
LAMBENT_FN int mip_level(vec2 uv_edge1, vec2 uv_edge2, vec2 uv_scale, int width, int height,
                         float share_of_triangle) {
  float triangle_texels =
      0.5f * abs((uv_edge1.x * uv_edge2.y - uv_edge1.y * uv_edge2.x) * uv_scale.x * uv_scale.y) *
      float(width) * float(height);
  float cone_texels = triangle_texels * share_of_triangle;
  if (!(cone_texels > 1.0f)) return 0;
  // round(log2(t) / 2) = floor(log2(2 t) / 2), and the exponent is the logarithm's floor
  return (int(floatBitsToUint(2.0f * cone_texels) >> 23u) - 127) / 2;
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
  float triangle_texels =
      0.5f * abs((uv_edge1.x * uv_edge2.y - uv_edge1.y * uv_edge2.x) * uv_scale.x * uv_scale.y) *
      float(width) * float(height);
  float cone_texels = triangle_texels * share_of_triangle;
  if (!(cone_texels > 1.0f)) return 0.0f;
  const uint mantissa_bits = 0x007FFFFFu;
  uint bits = floatBitsToUint(cone_texels);
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
