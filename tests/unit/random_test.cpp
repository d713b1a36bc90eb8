// SPDX-License-Identifier: Apache-2.0
#include "shared/random.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/chi_squared.h"

namespace lambent::random_test {
namespace {

constexpr int kSamples = 100000;
constexpr int kCells = 16;

TEST(Random, StreamIsUniformInPairs) {
  RandomStream random = make_random_stream(1u, 2u, 3u);
  std::vector<double> observed(kCells * kCells);
  for (int i = 0; i < kSamples; ++i) {
    const vec2 u = next_uniform2(random);
    ASSERT_GE(std::min(u.x, u.y), 0.0f);
    ASSERT_LT(std::max(u.x, u.y), 1.0f);
    observed[static_cast<int>(u.y * kCells) * kCells + static_cast<int>(u.x * kCells)] += 1.0;
  }
  const std::vector<double> expected(observed.size(),
                                     static_cast<double>(kSamples) / (kCells * kCells));
  EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation);
}

TEST(Random, FirstNumbersOfNeighbouringStreamsAreIndependent) {
  std::vector<double> observed(kCells * kCells);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    RandomStream a = make_random_stream(i, 0u, 1u);
    RandomStream b = make_random_stream(i + 1u, 0u, 1u);
    observed[static_cast<int>(next_uniform(a) * kCells) * kCells +
             static_cast<int>(next_uniform(b) * kCells)] += 1.0;
  }
  const std::vector<double> expected(observed.size(),
                                     static_cast<double>(kSamples) / (kCells * kCells));
  EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation);
}

TEST(Random, EveryArgumentOfAStreamMatters) {
  const std::uint32_t base = make_random_stream(1u, 1u, 1u).state;
  EXPECT_NE(base, make_random_stream(2u, 1u, 1u).state);
  EXPECT_NE(base, make_random_stream(1u, 2u, 1u).state);
  EXPECT_NE(base, make_random_stream(1u, 1u, 2u).state);
}

TEST(Random, LargestBitsStayBelowOne) {
  EXPECT_LT(uniform_from_bits(0xFFFFFFFFu), 1.0f);
  EXPECT_EQ(uniform_from_bits(0u), 0.0f);
}

}  // namespace
}  // namespace lambent::random_test
