// SPDX-License-Identifier: Apache-2.0
// Sixteen floats that are worked on together. The compiler splits them into the registers that a
// LAMBENT_SIMD_CLONES version has; every operation is elementwise, so all versions agree to the
// bit. To be used inside of one kernel and what is inlined into it, never across calls.
#pragma once

#include <cstdint>
#include <cstring>

#define LAMBENT_FORCE_INLINE __attribute__((always_inline)) inline

namespace lambent {

inline constexpr int kLanes = 16;

// vector_size is understood by g++ and clang.
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using LaneInts = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

/// kLanes floats from anywhere.
LAMBENT_FORCE_INLINE void load(Lanes& lanes, const float* from) {
  std::memcpy(&lanes, from, sizeof(lanes));
}

LAMBENT_FORCE_INLINE void store(float* to, const Lanes& lanes) {
  std::memcpy(to, &lanes, sizeof(lanes));
}

/// Zeroes the lanes where the mask is not set; masks are what comparisons of lanes yield.
LAMBENT_FORCE_INLINE void keep(Lanes& lanes, const LaneInts& mask) {
  LaneInts bits;
  std::memcpy(&bits, &lanes, sizeof(bits));
  bits &= mask;
  std::memcpy(&lanes, &bits, sizeof(bits));
}

}  // namespace lambent
