// SPDX-License-Identifier: Apache-2.0
#include "scene/emission_map.h"

#include <algorithm>
#include <cmath>

#include "core/byte_decoding.h"
#include "scene/attributes.h"
#include "scene/texture.h"
#include "shared/color.h"

namespace lambent {
namespace {

// Texels a block is wide and high: the table takes half a byte a texel.
constexpr int kBlock = 4;
// Steps of luminance between black and the brightest texel; sums of 2^40 texels stay exact in 64
// bits.
constexpr float kSteps = 65535.0f;
// Texels beyond the triangle that a bilinear lookup in it reads.
constexpr float kFilterRadius = 1.0f;

}  // namespace

EmissionMap::EmissionMap(const Scene& scene, const Material& material) {
  if (!may_emit(material)) return;
  const glm::vec3 factor = material.unlit ? glm::vec3(material.base_color) : material.emission;
  view_ = material.unlit ? material.base_color_texture : material.emission_texture;
  constant_ = luminance(factor);
  if (view_.texture < 0) return;

  const Texture& texture = scene.textures[view_.texture];
  const TextureLevel& level = texture.levels.front();
  width_ = level.width;
  height_ = level.height;
  columns_ = (width_ + kBlock - 1) / kBlock;
  rows_ = (height_ + kBlock - 1) / kBlock;
  unit_ = constant_ / kSteps;
  sums_.assign(static_cast<std::size_t>(columns_ + 1) * (rows_ + 1), 0);

  // Compute the sum of each block, every texel rounded up so that none that emits counts for
  // nothing
  const ByteDecoding& decode = texture.srgb ? srgb_byte_decoding() : linear_byte_decoding();
  const std::size_t stride = columns_ + 1;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::uint8_t* p = level.rgba.data() + (static_cast<std::size_t>(y) * width_ + x) * 4;
      if ((p[0] | p[1] | p[2]) == 0) continue;
      const glm::vec3 texel(decode[p[0]], decode[p[1]], decode[p[2]]);
      sums_[(y / kBlock + 1) * stride + x / kBlock + 1] +=
          static_cast<std::uint64_t>(std::ceil(luminance(factor * texel) / unit_));
    }
  }

  // Compute the summed-area table
  for (int y = 1; y <= rows_; ++y) {
    for (int x = 1; x <= columns_; ++x) {
      sums_[y * stride + x] +=
          sums_[y * stride + x - 1] + sums_[(y - 1) * stride + x] - sums_[(y - 1) * stride + x - 1];
    }
  }
}

// The blocks that an interval of texture coordinates touches; all of them where it crosses the
// texture's edge.
EmissionMap::BlockRange EmissionMap::blocks(float low, float high, int texels, int count,
                                            Wrap wrap) const {
  const BlockRange all = {0, count};
  if (!std::isfinite(low) || !std::isfinite(high)) return all;
  const float tile = wrap == Wrap::repeat ? std::floor(low) : 0.0f;
  const float size = static_cast<float>(texels);
  float first = (low - tile) * size - kFilterRadius;
  float last = (high - tile) * size + kFilterRadius;
  if (wrap == Wrap::clamp_to_edge) {
    first = std::clamp(first, 0.0f, size - 1.0f);
    last = std::clamp(last, 0.0f, size - 1.0f);
  }
  if (first < 0.0f || last >= size) return all;
  return {static_cast<int>(first) / kBlock, static_cast<int>(last) / kBlock + 1};
}

float EmissionMap::box_mean(BlockRange x, BlockRange y) const {
  const std::size_t stride = columns_ + 1;
  const std::uint64_t sum = sums_[y.last * stride + x.last] - sums_[y.first * stride + x.last] -
                            sums_[y.last * stride + x.first] + sums_[y.first * stride + x.first];
  // Blocks at the far edges may be cut off
  const int texels_x = std::min(x.last * kBlock, width_) - x.first * kBlock;
  const int texels_y = std::min(y.last * kBlock, height_) - y.first * kBlock;
  return unit_ *
         static_cast<float>(static_cast<double>(sum) / (static_cast<double>(texels_x) * texels_y));
}

float EmissionMap::mean_luminance(const Mesh& mesh, std::uint32_t triangle) const {
  if (sums_.empty()) return constant_;
  const std::vector<glm::vec2>& uvs = mesh.uvs[view_.uv_set];
  if (uvs.empty()) return box_mean({0, columns_}, {0, rows_});
  const glm::uvec3 v = mesh.triangles[triangle];
  const glm::vec2 a = transform_uv(view_, uvs[v.x]);
  const glm::vec2 b = transform_uv(view_, uvs[v.y]);
  const glm::vec2 c = transform_uv(view_, uvs[v.z]);
  const glm::vec2 low = glm::min(a, glm::min(b, c));
  const glm::vec2 high = glm::max(a, glm::max(b, c));
  return box_mean(blocks(low.x, high.x, width_, columns_, view_.wrap_u),
                  blocks(low.y, high.y, height_, rows_, view_.wrap_v));
}

}  // namespace lambent
