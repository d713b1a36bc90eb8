// SPDX-License-Identifier: Apache-2.0
#include "shared/octahedral.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shared/sampling.h"

namespace lambent::octahedral_test {
namespace {

TEST(Octahedral, DecodingUndoesEncoding) {
  for (std::uint32_t i = 0; i < 10000; ++i) {
    const vec3 direction = spherical_fibonacci(i, 10000);
    const vec2 p = octahedral_encode(direction);
    EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), 1.0f);
    EXPECT_NEAR(length(octahedral_decode(p) - direction), 0.0f, 1e-6f);
  }
}

TEST(Octahedral, EncodingUndoesDecoding) {
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      const vec2 p((static_cast<float>(x) + 0.5f) / 50.0f - 1.0f,
                   (static_cast<float>(y) + 0.5f) / 50.0f - 1.0f);
      EXPECT_NEAR(length(octahedral_encode(octahedral_decode(p)) - p), 0.0f, 1e-5f);
    }
  }
}

TEST(Octahedral, AxesAndSeamHaveTheirPlaces) {
  EXPECT_EQ(octahedral_encode({0.0f, 0.0f, 1.0f}), vec2(0.0f, 0.0f));
  EXPECT_EQ(octahedral_encode({0.0f, 0.0f, -1.0f}), vec2(1.0f, 1.0f));
  EXPECT_EQ(octahedral_encode({1.0f, 0.0f, 0.0f}), vec2(1.0f, 0.0f));
  EXPECT_NEAR(octahedral_decode({1.0f, 1.0f}).z, -1.0f, 1e-6f);
  EXPECT_NEAR(octahedral_decode({-1.0f, 1.0f}).z, -1.0f, 1e-6f);
}

TEST(Octahedral, LengthDoesNotMatter) {
  const vec3 direction(0.3f, -0.5f, -0.7f);
  EXPECT_NEAR(length(octahedral_encode(direction) - octahedral_encode(7.0f * direction)), 0.0f,
              1e-6f);
}

}  // namespace
}  // namespace lambent::octahedral_test
