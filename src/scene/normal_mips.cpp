// SPDX-License-Identifier: Apache-2.0
// MIPs of normal maps, which also hold how far most normals scatter.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>

#include "scene/texture.h"
#include "shared/color.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Most normals along each axis of which a coarse texel's spread is measured.
constexpr int kSamples = 4;
constexpr std::size_t kMostNormals = std::size_t{kSamples} * kSamples;
// Most normals are told from others in texels over at least this many along an axis: four normals
// are too few.
constexpr int kFewestNormals = 4;
// Median of the squared distances of normally distributed points of a plane from their centre, over
// the variance along each axis: 2 ln 2.
constexpr float kSquaredMedian = 1.3862944f;

// Alpha where normals do not scatter.
constexpr std::uint8_t kNoSpread = 255;

float square_of(float x, float y) {
  return x * x + y * y;
}

float median(std::span<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Normals' components along the surface.
struct Normals {
  std::array<float, kMostNormals> x, y;
  std::size_t count = 0;

  /// Variance along each axis.
  float variance() const {
    const float over_count = 1.0f / static_cast<float>(count);
    const std::size_t used = count;
    const float mean_x = std::accumulate(x.begin(), x.begin() + used, 0.0f) * over_count;
    const float mean_y = std::accumulate(y.begin(), y.begin() + used, 0.0f) * over_count;
    float sum = 0.0f;
    for (std::size_t i = 0; i < count; ++i) sum += square_of(x[i] - mean_x, y[i] - mean_y);
    return 0.5f * sum * over_count;
  }

  /// Variance along each axis of most of them, nearly half of them being anything, about the mean
  /// of all, which stands for them.
  float variance_of_most(float mean_x, float mean_y) const {
    std::array<float, kMostNormals> values = x;
    const std::span<float> some = std::span(values).first(count);
    const float center_x = median(some);
    values = y;
    const float center_y = median(some);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = square_of(x[i] - center_x, y[i] - center_y);
    }
    const float scatter = median(some) / kSquaredMedian;
    return scatter + 0.5f * square_of(mean_x - center_x, mean_y - center_y);
  }
};

/// First texel, and number of texels, of the finest level under a texel of a coarser one, and the
/// number of samples of them.
struct Extent {
  Extent(int i, int fine, int coarse)
      : begin(static_cast<int>(std::int64_t{i} * fine / coarse)),
        length(static_cast<int>((std::int64_t{i} + 1) * fine / coarse) - begin),
        samples(std::min(length, kSamples)) {}
  /// The texel in one of as many equal parts as there are samples, at this share of it.
  int sample(int part, float share) const {
    const float place = (static_cast<float>(part) + share) * static_cast<float>(length);
    return begin + std::min(static_cast<int>(place / static_cast<float>(samples)), length - 1);
  }

  int begin, length, samples;
};

float component(std::uint8_t byte) {
  return 2.0f * linear_byte_decoding()[byte] - 1.0f;
}

/// The alpha that stands for a spread.
std::uint8_t alpha_of(float spread) {
  return static_cast<std::uint8_t>(std::lround(kNoSpread * (1.0f - std::min(spread, 1.0f))));
}

/// Stores the spreads of a level's normals.
void measure_spread(const TextureLevel& finest, TextureLevel& coarse) {
  Normals normals;
  for (int y = 0; y < coarse.height; ++y) {
    const Extent rows(y, finest.height, coarse.height);
    for (int x = 0; x < coarse.width; ++x) {
      const Extent columns(x, finest.width, coarse.width);
      normals.count = 0;
      for (int r = 0; r < rows.samples; ++r) {
        for (int c = 0; c < columns.samples; ++c) {
          // Places are irregular, as maps may be regular
          const vec2 share = fract(vec2(0.5f) + plastic_sequence(static_cast<uint>(normals.count)));
          const std::size_t texel =
              static_cast<std::size_t>(rows.sample(r, share.x)) * finest.width +
              columns.sample(c, share.y);
          normals.x[normals.count] = component(finest.rgba[4 * texel]);
          normals.y[normals.count++] = component(finest.rgba[4 * texel + 1]);
        }
      }
      std::uint8_t* out = &coarse.rgba[4 * (static_cast<std::size_t>(y) * coarse.width + x)];
      float variance = normals.variance();
      if (std::max(rows.length, columns.length) >= kFewestNormals) {
        const float most = normals.variance_of_most(component(out[0]), component(out[1]));
        variance = std::min(variance, most);
      }
      out[3] = alpha_of(std::sqrt(variance));
    }
  }
}

}  // namespace

void build_normal_mips(Texture& texture) {
  assert(!texture.levels.empty() && !texture.srgb);
  TextureLevel& finest = texture.levels.front();
  for (std::size_t i = 3; i < finest.rgba.size(); i += 4) finest.rgba[i] = kNoSpread;
  build_mips(texture);
  for (std::size_t level = 1; level < texture.levels.size(); ++level) {
    measure_spread(texture.levels.front(), texture.levels[level]);
  }
}

}  // namespace lambent
