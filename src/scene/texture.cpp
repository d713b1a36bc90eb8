// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "shared/color.h"

namespace lambent {
namespace {

constexpr float kMaxByte = 255.0f;
// Entries of the table that encodes linear light: its steps are below a tenth of an 8-bit sRGB step
// where sRGB is steepest (12.92 * 255 / 65536 = 0.05).
constexpr int kEncodeEntries = 65536;

std::uint8_t byte_from_unit(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * kMaxByte));
}

std::uint8_t encode_srgb(float linear) {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> values(kEncodeEntries + 1);
    for (int i = 0; i <= kEncodeEntries; ++i) {
      values[i] = byte_from_unit(srgb_from_linear(static_cast<float>(i) / kEncodeEntries));
    }
    return values;
  }();
  return table[static_cast<std::size_t>(std::clamp(linear, 0.0f, 1.0f) * kEncodeEntries + 0.5f)];
}

// The texels of the finer level that one texel of the coarser covers, along one axis.
struct Taps {
  std::array<int, 3> index{};
  std::array<float, 3> weight{};
  int count = 0;
};

// Exact coverage of texel `i` of `coarse`, also where `fine` is odd and its texels cross borders.
Taps box_taps(int i, int fine, int coarse) {
  Taps taps;
  const float width = static_cast<float>(fine) / static_cast<float>(coarse);
  const float begin = static_cast<float>(i) * width;
  const float end = begin + width;
  constexpr float kNoCoverage = 1e-4f;  // Of a texel: less than this is rounding.
  for (int j = static_cast<int>(begin); j < fine && taps.count < 3; ++j) {
    const float from = std::max(begin, static_cast<float>(j));
    const float to = std::min(end, static_cast<float>(j + 1));
    if (to - from < kNoCoverage) continue;
    taps.index[taps.count] = j;
    taps.weight[taps.count] = (to - from) / width;
    ++taps.count;
  }
  return taps;
}

TextureLevel half_size(const TextureLevel& fine, bool srgb, MipWeights weights) {
  TextureLevel coarse;
  coarse.width = std::max(1, fine.width / 2);
  coarse.height = std::max(1, fine.height / 2);
  coarse.rgba.resize(static_cast<std::size_t>(coarse.width) * coarse.height * 4);
  const auto& color = srgb ? srgb_byte_decoding() : linear_byte_decoding();
  const auto& alpha = linear_byte_decoding();

  std::vector<Taps> columns(coarse.width);
  for (int x = 0; x < coarse.width; ++x) columns[x] = box_taps(x, fine.width, coarse.width);
  for (int y = 0; y < coarse.height; ++y) {
    const Taps rows = box_taps(y, fine.height, coarse.height);
    for (int x = 0; x < coarse.width; ++x) {
      // Average the covered texels in linear light
      glm::vec4 sum(0.0f);
      glm::vec3 covered(0.0f);
      for (int r = 0; r < rows.count; ++r) {
        for (int c = 0; c < columns[x].count; ++c) {
          const std::size_t texel =
              static_cast<std::size_t>(rows.index[r]) * fine.width + columns[x].index[c];
          const std::uint8_t* p = &fine.rgba[texel * 4];
          const float weight = rows.weight[r] * columns[x].weight[c];
          const glm::vec4 value(color[p[0]], color[p[1]], color[p[2]], alpha[p[3]]);
          sum += weight * value;
          covered += weight * value.a * glm::vec3(value);
        }
      }
      // Where nothing is covered, there is no such mean; see fill_uncovered()
      if (weights == MipWeights::alpha && sum.a > 0.0f) sum = glm::vec4(covered / sum.a, sum.a);
      std::uint8_t* out = &coarse.rgba[(static_cast<std::size_t>(y) * coarse.width + x) * 4];
      for (int k = 0; k < 3; ++k) out[k] = srgb ? encode_srgb(sum[k]) : byte_from_unit(sum[k]);
      out[3] = byte_from_unit(sum[3]);
    }
  }
  return coarse;
}

/// Gives texels that nothing covers the colour of what is around them, from the next level: it
/// shows beside covered ones where texels are interpolated.
void fill_uncovered(TextureLevel& level, const TextureLevel& coarser) {
  for (int y = 0; y < level.height; ++y) {
    const int above = std::min(y / 2, coarser.height - 1);
    for (int x = 0; x < level.width; ++x) {
      std::uint8_t* texel = &level.rgba[(static_cast<std::size_t>(y) * level.width + x) * 4];
      if (texel[3] > 0) continue;
      const int beside = std::min(x / 2, coarser.width - 1);
      const std::size_t from = static_cast<std::size_t>(above) * coarser.width + beside;
      std::copy_n(&coarser.rgba[from * 4], 3, texel);
    }
  }
}

}  // namespace

void check_first_level(const Texture& texture) {
  if (texture.levels.empty()) throw std::invalid_argument("a texture has no levels");
  const TextureLevel& level = texture.levels.front();
  if (level.width < 1 || level.height < 1) {
    throw std::invalid_argument("a texture has a level without pixels");
  }
  if (level.rgba.size() != static_cast<std::size_t>(level.width) * level.height * 4) {
    throw std::invalid_argument("a texture has a level whose pixels do not fill its size");
  }
}

void build_mips(Texture& texture, MipWeights weights) {
  check_first_level(texture);
  texture.levels.resize(1);
  while (texture.levels.back().width > 1 || texture.levels.back().height > 1) {
    texture.levels.push_back(half_size(texture.levels.back(), texture.srgb, weights));
  }
  if (weights == MipWeights::equal) return;
  // From the coarsest on, so that colours reach far; the file's own texels stay
  for (std::size_t level = texture.levels.size() - 1; level-- > 1;) {
    fill_uncovered(texture.levels[level], texture.levels[level + 1]);
  }
}

}  // namespace lambent
