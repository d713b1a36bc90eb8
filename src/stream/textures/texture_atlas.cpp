// SPDX-License-Identifier: Apache-2.0
#include "stream/textures/texture_atlas.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lambent::stream {
namespace {

constexpr float kLargestCode = 1023.0f;  // of 10 bits

std::uint16_t code(float share) {
  return static_cast<std::uint16_t>(std::clamp(share, 0.0f, 1.0f) * kLargestCode + 0.5f);
}

/// The mean, red less blue, and red and blue less twice green, each from 0 to 1.
std::array<std::uint16_t, 3> codes_of(const glm::vec3& root) {
  return {code((root.r + root.g + root.b) / 3.0f), code((root.r - root.b) / 2.0f + 0.5f),
          code((root.r + root.b - 2.0f * root.g) / 4.0f + 0.5f)};
}

glm::vec3 root_of(const std::array<std::uint16_t, 3>& codes) {
  const float mean = static_cast<float>(codes[0]) / kLargestCode;
  const float across = static_cast<float>(codes[1]) / kLargestCode - 0.5f;
  const float off_green = static_cast<float>(codes[2]) / kLargestCode - 0.5f;
  const float red_and_blue = mean + off_green * (2.0f / 3.0f);
  return {red_and_blue + across, mean - off_green * (4.0f / 3.0f), red_and_blue - across};
}

int whole_blocks(int pixels) {
  const int blocks = (pixels + TextureAtlas::kBlock - 1) / TextureAtlas::kBlock;
  return std::max(blocks * TextureAtlas::kBlock, TextureAtlas::kLeastEdge);
}

}  // namespace

TextureAtlas::TextureAtlas(int probes, int edge, int tiles_in_row)
    : probes_(probes),
      edge_(edge),
      tiles_in_row_(tiles_in_row),
      width_(whole_blocks(tiles_in_row * edge)),
      height_(whole_blocks((probes + tiles_in_row - 1) / tiles_in_row * edge)) {}

Expected<TextureAtlas> TextureAtlas::of(const FieldGeometry& geometry) {
  // Put whole rows of the first volume side by side, so that neighbouring probes are also
  // neighbours vertically
  const int row = geometry.volumes.front().grid.count.x;
  const auto square = static_cast<int>(std::sqrt(static_cast<double>(geometry.probes())));
  const TextureAtlas atlas(geometry.probes(), geometry.irradiance_texels,
                           std::max((square + row / 2) / row, 1) * row);
  if (std::max(atlas.width_, atlas.height_) > kMaxEdge) {
    return fail("light stream", "", "has too many probes for one picture of a video codec");
  }
  return atlas;
}

std::size_t TextureAtlas::pixel(int probe, int texel) const {
  const int x = probe % tiles_in_row_ * edge_ + texel % edge_;
  const int y = probe / tiles_in_row_ * edge_ + texel / edge_;
  return static_cast<std::size_t>(y) * width_ + x;
}

void TextureAtlas::draw(const LightLayout& layout, std::span<const glm::vec4> tiles, float scale,
                        TexturePicture& picture) const {
  picture.width = width_;
  picture.height = height_;
  for (std::vector<std::uint16_t>& plane : picture.planes) {
    plane.resize(static_cast<std::size_t>(width_) * height_);
  }
  const int texels = edge_ * edge_;
  int lit = -1;  // the last lit probe
  for (int probe = 0; probe < probes_; ++probe) {
    if (layout.lit[probe] != 0) lit = probe;
    if (lit < 0) continue;
    for (int t = 0; t < texels; ++t) {
      const glm::vec3 light(tiles[static_cast<std::size_t>(lit) * texels + t]);
      const auto codes = codes_of(glm::sqrt(glm::max(light, 0.0f)) / scale);
      const std::size_t at = pixel(probe, t);
      for (std::size_t c = 0; c < codes.size(); ++c) picture.planes[c][at] = codes[c];
    }
  }
}

std::vector<glm::vec4> TextureAtlas::tiles_of(const TexturePicture& picture, float scale) const {
  const int texels = edge_ * edge_;
  std::vector<glm::vec4> tiles(static_cast<std::size_t>(probes_) * texels);
  for (int probe = 0; probe < probes_; ++probe) {
    for (int t = 0; t < texels; ++t) {
      const std::size_t at = pixel(probe, t);
      const glm::vec3 root = glm::max(
          root_of({picture.planes[0][at], picture.planes[1][at], picture.planes[2][at]}) * scale,
          0.0f);
      tiles[static_cast<std::size_t>(probe) * texels + t] = glm::vec4(root * root, 0.0f);
    }
  }
  return tiles;
}

}  // namespace lambent::stream
