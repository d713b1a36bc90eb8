// SPDX-License-Identifier: Apache-2.0
// Based on: Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors",
// JCGT 3(2), 2014.
#ifndef LAMBENT_SHARED_OCTAHEDRAL_H
#define LAMBENT_SHARED_OCTAHEDRAL_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// +1 or -1, never 0, so that the fold of the octahedron has no seam.
LAMBENT_FN float sign_not_zero(float value) {
  return value >= 0.0f ? 1.0f : -1.0f;
}

/// The point of the square [-1, 1]^2 that represents a direction (need not be unit, must not be
/// zero). The upper half (z >= 0) maps to the inner diamond.
LAMBENT_FN vec2 octahedral_encode(vec3 direction) {
  float l1_norm = abs(direction.x) + abs(direction.y) + abs(direction.z);
  vec2 p = vec2(direction.x / l1_norm, direction.y / l1_norm);
  if (direction.z < 0.0f) {
    p = vec2((1.0f - abs(p.y)) * sign_not_zero(p.x), (1.0f - abs(p.x)) * sign_not_zero(p.y));
  }
  return p;
}

/// The unit direction for a point of the square [-1, 1]^2. Inverse of octahedral_encode.
LAMBENT_FN vec3 octahedral_decode(vec2 p) {
  vec3 v = vec3(p.x, p.y, 1.0f - abs(p.x) - abs(p.y));
  if (v.z < 0.0f) {
    v = vec3((1.0f - abs(p.y)) * sign_not_zero(p.x), (1.0f - abs(p.x)) * sign_not_zero(p.y), v.z);
  }
  return normalize(v);
}

// Steps of each coordinate of a packed unit vector: 16 bits, less one so that 0 has a code.
const float kUnitVectorSteps = 65534.0f;

/// A unit vector in a word, 16 bits per coordinate, with an error of at most 6e-5 rad.
LAMBENT_FN uint encode_unit_vector(vec3 direction) {
  vec2 p = octahedral_encode(direction);
  uint x = uint((p.x * 0.5f + 0.5f) * kUnitVectorSteps + 0.5f);
  uint y = uint((p.y * 0.5f + 0.5f) * kUnitVectorSteps + 0.5f);
  return x | (y << 16u);
}

LAMBENT_FN vec3 decode_unit_vector(uint word) {
  vec2 p = vec2(float(word & 0xFFFFu), float(word >> 16u)) * (2.0f / kUnitVectorSteps);
  return octahedral_decode(p - vec2(1.0f));
}

LAMBENT_END
#endif
