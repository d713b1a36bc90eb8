// SPDX-License-Identifier: Apache-2.0
// MIPs of normal maps, which also hold how far most normals scatter.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

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

// Distance of the points of Gauss-Legendre quadrature from the ends of an interval, over its
// length: (1 - sqrt(1/3)) / 2.
constexpr float kGaussPoint = 0.21132487f;

// Shorter vectors have no direction. A vector of 0 is stored with an error of up to 1/255 along
// each axis, which is 0.007 in all; this is three times as long.
constexpr float kShortestVector = 0.02f;

// Half of the range of a byte, which holds a component of a vector, -1 to 1.
constexpr float kHalfRange = 127.5f;

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

/// Stores a vector with the length 1, of which component() gives the components; nothing where it
/// has no direction.
void store_unit(const glm::vec3& vector, std::uint8_t* texel) {
  const float squared = glm::dot(vector, vector);
  if (squared < kShortestVector * kShortestVector) return;
  const float scale = kHalfRange / std::sqrt(squared);
  for (int c = 0; c < 3; ++c) {
    // + 0.5 rounds
    texel[c] = static_cast<std::uint8_t>(vector[c] * scale + (kHalfRange + 0.5f));
  }
}

/// The normals that a normal map shows at full size, where its texels are interpolated and given
/// the length 1: one for each texel, at the points of Gauss-Legendre quadrature between the texels
/// of blocks of 2 x 2. Maps with noise from texel to texel scatter less than their texels do, and
/// texels are often not of length 1. Vectors without a direction stay as they are.
std::vector<std::uint8_t> shown_normals(const TextureLevel& level) {
  std::vector<std::uint8_t> shown = level.rgba;
  const auto texel = [&](int x, int y) {
    return 4 * (static_cast<std::size_t>(y) * level.width + x);
  };
  const auto vector_at = [&](int x, int y) {
    const std::uint8_t* p = &level.rgba[texel(x, y)];
    return glm::vec3(component(p[0]), component(p[1]), component(p[2]));
  };
  const auto show = [&](int x, int y, const glm::vec3& near, const glm::vec3& far) {
    store_unit(glm::mix(near, far, kGaussPoint), &shown[texel(x, y)]);
  };
  for (int y = 0; y < level.height; y += 2) {
    const int below = std::min(y + 1, level.height - 1);
    for (int x = 0; x < level.width; x += 2) {
      const int beside = std::min(x + 1, level.width - 1);
      const glm::vec3 a = vector_at(x, y), b = vector_at(beside, y), c = vector_at(x, below),
                      d = vector_at(beside, below);
      const glm::vec3 a_c = glm::mix(a, c, kGaussPoint), b_d = glm::mix(b, d, kGaussPoint),
                      c_a = glm::mix(c, a, kGaussPoint), d_b = glm::mix(d, b, kGaussPoint);
      show(x, y, a_c, b_d);
      show(beside, y, b_d, a_c);
      show(x, below, c_a, d_b);
      show(beside, below, d_b, c_a);
    }
  }
  return shown;
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
  check_first_level(texture);
  if (texture.srgb) throw std::invalid_argument("a normal map is sRGB-encoded");
  TextureLevel& finest = texture.levels.front();
  for (std::size_t i = 3; i < finest.rgba.size(); i += 4) finest.rgba[i] = kNoSpread;
  std::vector<std::uint8_t> given = shown_normals(finest);
  given.swap(finest.rgba);
  build_mips(texture);
  for (std::size_t level = 1; level < texture.levels.size(); ++level) {
    measure_spread(texture.levels.front(), texture.levels[level]);
  }
  texture.levels.front().rgba.swap(given);
}

}  // namespace lambent
