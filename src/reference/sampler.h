// SPDX-License-Identifier: Apache-2.0
// Based on: Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shared/owen.h"
#include "shared/random.h"

namespace lambent::reference {

/// Second dimension of Sobol's sequence for a point's index, as bits after the binary point.
inline std::uint32_t sobol_second_dimension(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1) {
    if ((index & 1u) != 0) result ^= v;
  }
  return result;
}

/// Random numbers for one sample of a path: every pair is a point of a two-dimensional Sobol
/// sequence over the samples of its pixel, scrambled and shuffled independently of all other pairs,
/// and hence stratified but uncorrelated. Each number on its own is uniform, so that estimates stay
/// unbiased.
class SobolSampler {
 public:
  /// `pixel_seed` must differ between pixels, and between sets of samples that are to be
  /// independent.
  SobolSampler(std::uint32_t pixel_seed, std::uint32_t sample_index)
      : seed_(pixel_seed), reversed_index_(bitfieldReverse(sample_index)) {}

  glm::vec2 next2() {
    const uvec3 hash = hash_pcg3d(uvec3(seed_, dimension_++, 0u));
    // Shuffle the order of the points, so that pairs are not correlated
    const std::uint32_t index = bitfieldReverse(scramble_reversed(reversed_index_, hash.x));
    // The first dimension is the reversed index, which scrambling needs reversed once more
    const std::uint32_t x = bitfieldReverse(scramble_reversed(index, hash.y));
    const std::uint32_t y =
        bitfieldReverse(scramble_reversed(bitfieldReverse(sobol_second_dimension(index)), hash.z));
    return {uniform_from_bits(x), uniform_from_bits(y)};
  }

  float next1() { return next2().x; }

  /// Three numbers of which the first two are stratified together, the third alone.
  glm::vec3 next3() {
    const glm::vec2 pair = next2();
    return {pair, next1()};
  }

 private:
  std::uint32_t seed_;
  std::uint32_t reversed_index_;
  std::uint32_t dimension_ = 0;
};

}  // namespace lambent::reference
