// SPDX-License-Identifier: Apache-2.0
// The encoding of sides of triangles that bound solid matter: two bits a triangle, kSolidBack and
// kSolidFront, kSidesPerWord triangles a word; each instance begins with a word of its own.
#ifndef LAMBENT_RAYTRACING_SOLID_SIDES_MATH_H
#define LAMBENT_RAYTRACING_SOLID_SIDES_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

const uint kSolidBack = 1u;
const uint kSolidFront = 2u;
const uint kSidesPerWord = 16u;

/// The word that holds a triangle's bits, counted from the first one of its instance.
LAMBENT_FN uint solid_sides_word(uint triangle) {
  return triangle / kSidesPerWord;
}

/// Position of a triangle's bits in their word.
LAMBENT_FN uint solid_sides_shift(uint triangle) {
  return 2u * (triangle % kSidesPerWord);
}

/// Whether the side of a triangle bounds solid matter: 1 or 0. `word` is its word; `front_face` is
/// 1 for the side from which its vertices run counter-clockwise.
LAMBENT_FN uint bounds_solid(uint word, uint triangle, uint front_face) {
  uint side = front_face != 0u ? kSolidFront : kSolidBack;
  return ((word >> solid_sides_shift(triangle)) & side) != 0u ? 1u : 0u;
}

LAMBENT_END
#endif
