// SPDX-License-Identifier: Apache-2.0
#include "stream/light/light_signal.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/simd.h"

namespace lambent::stream {
namespace {

// Orthonormal directions of colour: grey; red less blue; red and blue less green.
// 1 / sqrt(3), 1 / sqrt(2), 1 / sqrt(6)
constexpr float kThird = 0.577350269f, kHalf = 0.707106781f, kSixth = 0.408248290f;
constexpr std::array<std::array<float, kChannels>, kChannels> kAxes = {
    {{kThird, kThird, kThird}, {kHalf, 0.0f, -kHalf}, {kSixth, -2.0f * kSixth, kSixth}}};

using ChannelTexels = std::array<std::array<float, kMaxTileTexels>, kChannels>;

/// The scalar products of a tile with all functions of a basis. `values` holds those of all
/// functions at a texel, one texel after the other.
LAMBENT_SIMD_CLONES void project(const float* tile, const float* values, std::size_t texels,
                                 float* coefficients) {
  std::fill_n(coefficients, texels, 0.0f);
  for (std::size_t t = 0; t < texels; ++t) {
    for (std::size_t i = 0; i < texels; ++i) coefficients[i] += tile[t] * values[t * texels + i];
  }
}

/// Adds `factor` times each of the values to the sums.
void add_scaled(float factor, const float* values, float* sums, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += factor * values[i];
}

}  // namespace

void LightSignal::coefficients_of(std::span<const glm::vec4> tile,
                                  std::span<float> coefficients) const {
  const std::size_t texels = basis_.size();
  assert(tile.size() == texels && coefficients.size() == kChannels * texels);
  ChannelTexels roots;
  const float per_unit = 1.0f / unit_;
  for (std::size_t t = 0; t < texels; ++t) {
    std::array<float, kChannels> root;
    for (int c = 0; c < kChannels; ++c) root[c] = std::sqrt(std::max(tile[t][c], 0.0f)) * per_unit;
    for (int a = 0; a < kChannels; ++a) {
      roots[a][t] = kAxes[a][0] * root[0] + kAxes[a][1] * root[1] + kAxes[a][2] * root[2];
    }
  }
  for (int c = 0; c < kChannels; ++c) {
    project(roots[c].data(), basis_.texel(0), texels, &coefficients[c * texels]);
  }
}

void LightSignal::light_of(std::span<const std::int32_t> coefficients,
                           std::span<glm::vec3> tile) const {
  const std::size_t texels = basis_.size();
  assert(tile.size() == texels && coefficients.size() == kChannels * texels);
  ChannelTexels roots;
  for (int c = 0; c < kChannels; ++c) {
    std::fill_n(roots[c].begin(), texels, 0.0f);
    for (std::size_t i = 0; i < texels; ++i) {
      const std::int32_t number = coefficients[c * texels + i];
      if (number == 0) continue;
      add_scaled(static_cast<float>(number) * unit_, basis_.function(i), roots[c].data(), texels);
    }
  }
  for (std::size_t t = 0; t < texels; ++t) {
    for (int c = 0; c < kChannels; ++c) {
      const float root = std::max(
          kAxes[0][c] * roots[0][t] + kAxes[1][c] * roots[1][t] + kAxes[2][c] * roots[2][t], 0.0f);
      tile[t][c] = root * root;
    }
  }
}

}  // namespace lambent::stream
