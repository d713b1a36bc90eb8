// SPDX-License-Identifier: Apache-2.0
// The filter at the borders of a picture.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "denoise/atrous_pass.h"
#include "support/noisy_wall.h"

namespace lambent::denoise_borders_test {
namespace {

TEST(DenoiseBorders, MirrorThePicture) {
  for (const int size : {1, 2, 3, 5}) {
    for (int place = 0; place < size; ++place) EXPECT_EQ(mirrored_place(place, size), place);
    for (int beyond = 1; beyond <= kDenoiseGuard; ++beyond) {
      for (const int place : {-beyond, size - 1 + beyond}) {
        const int shown = mirrored_place(place, size);
        ASSERT_GE(shown, 0);
        ASSERT_LT(shown, size);
        EXPECT_EQ(beyond_ends(place, size), beyond);
      }
    }
  }
  EXPECT_EQ(mirrored_place(-2, 5), 2);
  EXPECT_EQ(mirrored_place(6, 5), 2);
  EXPECT_EQ(mirrored_place(9, 5), 1);
}

TEST(DenoiseBorders, LeaveNoLinesWhereNeighboursAreBeyondThem) {
  constexpr int kSize = 150;
  test::Wall wall(kSize, kSize);
  wall.set_light([](int, int, float u) { return test::one_in_eight(u); });
  const std::vector<vec3> smooth = wall.filtered();
  // Mean difference of adjacent columns, and of adjacent rows
  std::vector<double> columns(kSize, 0.0), rows(kSize, 0.0);
  for (int x = 1; x < kSize; ++x) {
    for (int y = 0; y < kSize; ++y) {
      columns[x] += std::abs(smooth[wall.at(x, y)].x - smooth[wall.at(x - 1, y)].x) / kSize;
      rows[x] += std::abs(smooth[wall.at(y, x)].x - smooth[wall.at(y, x - 1)].x) / kSize;
    }
  }
  for (const std::vector<double>& differences : {columns, rows}) {
    const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) / kSize;
    for (const int apart : {8, 16, 32}) {
      EXPECT_LT(differences[apart], 1.5 * mean) << apart;
      EXPECT_LT(differences[kSize - apart], 1.5 * mean) << apart;
    }
  }
}

}  // namespace
}  // namespace lambent::denoise_borders_test
