// SPDX-License-Identifier: Apache-2.0
// Vectors of kLanes floats in registers of the instruction set for which this file is included: see
// core/simd_levels.h. Without an include guard; included inside a namespace.

// vector_size is understood by g++ and clang.
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using LaneInts = int __attribute__((vector_size(kLanes * sizeof(int))));

/// Loads kLanes floats from any address.
LAMBENT_FORCE_INLINE void load(Lanes& lanes, const float* from) {
  __builtin_memcpy(&lanes, from, sizeof(lanes));
}

LAMBENT_FORCE_INLINE void store(float* to, const Lanes& lanes) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}

LAMBENT_FORCE_INLINE Lanes min(const Lanes& a, const Lanes& b) {
  return a < b ? a : b;
}
LAMBENT_FORCE_INLINE Lanes max(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}
LAMBENT_FORCE_INLINE Lanes select(const LaneInts& condition, const Lanes& yes, float no) {
  return condition ? yes : no;
}

/// pack_upper_halves (shared/packing.h), for lanes.
LAMBENT_FORCE_INLINE void pack_halves(Lanes& word, const Lanes& upper, const Lanes& lower) {
  constexpr int kRounding = static_cast<int>(kHalfOfLowerHalf);
  constexpr int kUpper = static_cast<int>(kUpperHalf);
  const auto up = ((LaneInts)upper + kRounding) & kUpper;
  const auto low = ((LaneInts)lower + kRounding) >> static_cast<int>(kHalfBits);
  word = (Lanes)(up | (low & ~kUpper));
}

/// unpack_upper_half and unpack_lower_half, for lanes.
LAMBENT_FORCE_INLINE void unpack_halves(Lanes& upper, Lanes& lower, const Lanes& word) {
  upper = (Lanes)((LaneInts)word & static_cast<int>(kUpperHalf));
  lower = (Lanes)((LaneInts)word << static_cast<int>(kHalfBits));
}
