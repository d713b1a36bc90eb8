// SPDX-License-Identifier: Apache-2.0
// Random numbers that belong to places, for choices among the cells around a point.
#ifndef LAMBENT_SHARED_PLACE_HASH_H
#define LAMBENT_SHARED_PLACE_HASH_H

#include "shared/random.h"

LAMBENT_BEGIN

// A cell has kPlaceSteps parts along each axis, and all points in a part have the same numbers, so
// that these do not depend on how a backend rounds. kPlaceShift moves the borders of the parts away
// from round coordinates, at which surfaces often are.
const float kPlaceSteps = 64.0f;
const float kPlaceShift = 0.37f;

/// A random point of the unit cube, from a hash of a point in space [cells].
LAMBENT_FN vec3 hash_of_place(vec3 coords) {
  vec3 part = floor(coords * kPlaceSteps + vec3(kPlaceShift));
  uvec3 mixed =
      hash_pcg3d(uvec3(floatBitsToUint(part.x), floatBitsToUint(part.y), floatBitsToUint(part.z)));
  return vec3(uniform_from_bits(mixed.x), uniform_from_bits(mixed.y), uniform_from_bits(mixed.z));
}

LAMBENT_END
#endif
