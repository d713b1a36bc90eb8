// SPDX-License-Identifier: Apache-2.0
// kLanes floats that are worked on together, in the registers of the instruction set that this is
// included for: see core/simd_levels.h. Without guard; included inside a namespace.

// vector_size is understood by g++ and clang.
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using LaneInts = int __attribute__((vector_size(kLanes * sizeof(int))));

/// kLanes floats from anywhere.
LAMBENT_FORCE_INLINE void load(Lanes& lanes, const float* from) {
  __builtin_memcpy(&lanes, from, sizeof(lanes));
}

LAMBENT_FORCE_INLINE void store(float* to, const Lanes& lanes) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}

/// Zeroes the lanes where the mask is not set; masks are what comparisons of lanes yield.
LAMBENT_FORCE_INLINE void keep(Lanes& lanes, const LaneInts& mask) {
  lanes = mask ? lanes : Lanes{};
}

// Two values in the place of one float: the upper halves of each (8 bits of mantissa), rounded.
constexpr int kUpperHalf = static_cast<int>(0xFFFF0000u), kHalfOfLowerHalf = 0x8000;
constexpr int kHalfBits = 16;

LAMBENT_FORCE_INLINE void pack_halves(Lanes& word, const Lanes& upper, const Lanes& lower) {
  const auto up = ((LaneInts)upper + kHalfOfLowerHalf) & kUpperHalf;
  const auto low = ((LaneInts)lower + kHalfOfLowerHalf) >> kHalfBits;
  word = (Lanes)(up | (low & ~kUpperHalf));
}

LAMBENT_FORCE_INLINE void unpack_halves(Lanes& upper, Lanes& lower, const Lanes& word) {
  upper = (Lanes)((LaneInts)word & kUpperHalf);
  lower = (Lanes)((LaneInts)word << kHalfBits);
}
