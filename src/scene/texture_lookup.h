// SPDX-License-Identifier: Apache-2.0
// The texels that a texture coordinate reads.
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

LAMBENT_END
#endif
