// SPDX-License-Identifier: Apache-2.0
#include "stream/light/light_signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "field/probes/tile.h"

namespace lambent::stream::light_signal_test {
namespace {

TEST(TileBasis, IsOrthonormalInTilesOfAllSizes) {
  for (int edge = 2; edge <= 16; edge += 2) {
    const TileBasis basis(edge);
    ASSERT_EQ(basis.size(), static_cast<std::size_t>(edge) * edge);
    for (std::size_t i = 0; i < basis.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (std::size_t t = 0; t < basis.size(); ++t) {
          sum += double{basis.at(i, t)} * basis.at(j, t);
        }
        ASSERT_NEAR(sum, i == j ? 1.0 : 0.0, 1e-5) << edge << ": " << i << ", " << j;
      }
    }
  }
}

TEST(TileBasis, HasLightOfLowDegreeInItsFirstFunctions) {
  constexpr int kEdge = 4;
  const TileBasis basis(kEdge);
  // An irradiance of degrees 0 to 2: nine functions hold all of it
  for (std::size_t i = 9; i < basis.size(); ++i) {
    double sum = 0.0;
    for (int t = 0; t < kEdge * kEdge; ++t) {
      const vec3 d = tile_direction({t % kEdge, t / kEdge}, kEdge);
      sum += basis.at(i, t) * (2.0f + d.x - 0.5f * d.z + 0.7f * d.x * d.y + 0.3f * d.z * d.z);
    }
    EXPECT_NEAR(sum, 0.0, 1e-5) << i;
  }
}

TEST(LightSignal, GivesBackTheLightToWithinItsUnit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> share(0.0f, 1.0f);
  for (const int edge : {2, 4, 6, 8, 16}) {
    const TileBasis basis(edge);
    for (const float brightness : {1e-6f, 1.0f, 1e7f}) {
      const float unit = 0.001f * std::sqrt(brightness);
      const LightSignal signal(basis, unit);
      std::vector<glm::vec4> tile;
      for (std::size_t t = 0; t < basis.size(); ++t) {
        const auto channel = [&] { return brightness * share(random) * share(random); };
        tile.emplace_back(channel(), channel(), channel(), 0.0f);
      }
      tile[1] = glm::vec4(0.0f);
      std::vector<float> coefficients(kChannels * basis.size());
      signal.coefficients_of(tile, coefficients);
      std::vector<std::int32_t> rounded;
      rounded.reserve(coefficients.size());
      for (const float number : coefficients) {
        rounded.push_back(static_cast<std::int32_t>(std::lround(number)));
      }
      std::vector<glm::vec3> back(basis.size());
      signal.light_of(rounded, back);
      // Of a tile's roots the square error is that of its coefficients, each off by half a unit
      double square = 0.0;
      for (std::size_t t = 0; t < basis.size(); ++t) {
        for (int c = 0; c < kChannels; ++c) {
          const double error = std::sqrt(back[t][c]) - std::sqrt(tile[t][c]);
          square += error * error;
        }
      }
      EXPECT_LE(square, 0.2501 * unit * unit * static_cast<double>(coefficients.size())) << edge;
    }
  }
}

TEST(LightSignal, HoldsGreyLightInOneNumber) {
  const TileBasis basis(4);
  const std::vector<glm::vec4> tile(16, glm::vec4(0.25f, 0.25f, 0.25f, 0.0f));
  std::vector<float> coefficients(48);
  LightSignal(basis, 0.5f).coefficients_of(tile, coefficients);
  // sqrt(0.25) of 16 texels and 3 channels in one: 0.5 * sqrt(48) / 0.5
  EXPECT_NEAR(coefficients[0], std::sqrt(48.0f), 1e-4f);
  for (std::size_t i = 1; i < coefficients.size(); ++i) EXPECT_NEAR(coefficients[i], 0.0f, 1e-4f);
}

}  // namespace
}  // namespace lambent::stream::light_signal_test
