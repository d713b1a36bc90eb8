// SPDX-License-Identifier: Apache-2.0
// Based on: Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.
#ifndef LAMBENT_SHARED_OWEN_H
#define LAMBENT_SHARED_OWEN_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Owen's nested uniform scrambling of a bit-reversed value: each bit is flipped or not by a hash
/// of those below it. The hash is the improved Laine-Karras permutation of Vegdahl, "Building a
/// Better LK Hash", 2021.
LAMBENT_FN uint scramble_reversed(uint v, uint seed) {
  v ^= v * 0x3D20ADEAu;
  v += seed;
  v *= (seed >> 16) | 1u;
  v ^= v * 0x05526C56u;
  v ^= v * 0x53A22864u;
  return v;
}

LAMBENT_END
#endif
