// SPDX-License-Identifier: Apache-2.0
#include "scene/emission/emission_map.h"

#include <algorithm>
#include <cmath>

#include "core/byte_decoding.h"
#include "scene/attributes.h"
#include "scene/texture.h"
#include "shared/color.h"

namespace lambent {
namespace {

// Blocks of a large texture are this wide and high [texels]: the table takes half a byte per texel.
constexpr int kLargeBlock = 4;
// Textures of up to this many texels have blocks of a single texel: the table takes 2 MB at most,
// and boxes contain only texels that a lookup can touch.
constexpr int kMostSingleTexels = 512 * 512;
// There are this many steps of luminance between black and the brightest texel: sums of 2^40 texels
// stay exact in 64 bits.
constexpr float kSteps = 65535.0f;
// A bilinear lookup in a triangle reads texels up to this far beyond it [texels].
constexpr float kFilterRadius = 1.0f;
// A piece is halved again only if it covers at least this many blocks of texels along its longer
// side: its halves then cover twice what the filter's radius adds to the box around them.
constexpr int kLeastHalved = 8;

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
  block_ = std::int64_t{width_} * height_ <= kMostSingleTexels ? 1 : kLargeBlock;
  columns_ = (width_ + block_ - 1) / block_;
  rows_ = (height_ + block_ - 1) / block_;
  unit_ = constant_ / kSteps;
  sums_.assign(static_cast<std::size_t>(columns_ + 1) * (rows_ + 1), 0);

  // Compute the sum of each block, with every texel rounded up so that none that emits counts as 0
  const ByteDecoding& decode = texture.srgb ? srgb_byte_decoding() : linear_byte_decoding();
  const std::size_t stride = columns_ + 1;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::uint8_t* p = level.rgba.data() + (static_cast<std::size_t>(y) * width_ + x) * 4;
      if ((p[0] | p[1] | p[2]) == 0) continue;
      const glm::vec3 texel(decode[p[0]], decode[p[1]], decode[p[2]]);
      sums_[(y / block_ + 1) * stride + x / block_ + 1] +=
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

// Returns the blocks that an interval of texture coordinates touches. These are all blocks if the
// interval is as long as the texture, or if it crosses the edge of a texture that is mirrored.
EmissionMap::WrappedRange EmissionMap::blocks(float low, float high, int texels, int count,
                                              Wrap wrap) const {
  const WrappedRange all = {{0, count}, {0, 0}};
  if (!std::isfinite(low) || !std::isfinite(high)) return all;
  const float tile = wrap == Wrap::repeat ? std::floor(low) : 0.0f;
  const float size = static_cast<float>(texels);
  float first = (low - tile) * size - kFilterRadius;
  float last = (high - tile) * size + kFilterRadius;
  if (wrap == Wrap::clamp_to_edge) {
    first = std::clamp(first, 0.0f, size - 1.0f);
    last = std::clamp(last, 0.0f, size - 1.0f);
  }
  if (first >= 0.0f && last < size) {
    return {{static_cast<int>(first) / block_, static_cast<int>(last) / block_ + 1}, {0, 0}};
  }
  if (wrap != Wrap::repeat || !(last - first < size)) return all;
  if (first < 0.0f) first += size;
  if (last >= size) last -= size;
  // Rounding may have moved one of them onto the edge
  const int begin = std::clamp(static_cast<int>(first), 0, texels - 1) / block_;
  const int end = std::clamp(static_cast<int>(last), 0, texels - 1) / block_ + 1;
  if (end >= begin) return all;
  return {{begin, count}, {0, end}};
}

std::uint64_t EmissionMap::box_sum(BlockRange x, BlockRange y) const {
  const std::size_t stride = columns_ + 1;
  return sums_[y.last * stride + x.last] - sums_[y.first * stride + x.last] -
         sums_[y.last * stride + x.first] + sums_[y.first * stride + x.first];
}

float EmissionMap::box_mean(const WrappedRange& x, const WrappedRange& y) const {
  const std::uint64_t sum = box_sum(x.range, y.range) + box_sum(x.rest, y.range) +
                            box_sum(x.range, y.rest) + box_sum(x.rest, y.rest);
  // Blocks at the far edges may be incomplete
  const auto texels = [&](BlockRange range, int size) {
    return std::min(range.last * block_, size) - range.first * block_;
  };
  const int texels_x = texels(x.range, width_) + texels(x.rest, width_);
  const int texels_y = texels(y.range, height_) + texels(y.rest, height_);
  return unit_ *
         static_cast<float>(static_cast<double>(sum) / (static_cast<double>(texels_x) * texels_y));
}

std::optional<UvTriangle> EmissionMap::uvs_of(const Mesh& mesh, std::uint32_t triangle) const {
  if (sums_.empty() || mesh.uvs[view_.uv_set].empty()) return std::nullopt;
  const std::vector<glm::vec2>& uvs = mesh.uvs[view_.uv_set];
  const glm::uvec3 v = mesh.triangles[triangle];
  return UvTriangle{transform_uv(view_, uvs[v.x]), transform_uv(view_, uvs[v.y]),
                    transform_uv(view_, uvs[v.z])};
}

int EmissionMap::useful_halvings(const UvTriangle& piece) const {
  const glm::vec2 size =
      glm::max(piece.a, glm::max(piece.b, piece.c)) - glm::min(piece.a, glm::min(piece.b, piece.c));
  float texels =
      std::max(size.x * static_cast<float>(width_), size.y * static_cast<float>(height_));
  if (!std::isfinite(texels)) return 0;
  int halvings = 0;
  for (; texels >= static_cast<float>(kLeastHalved * block_); texels *= 0.5f) ++halvings;
  return halvings;
}

float EmissionMap::mean_luminance(const Mesh& mesh, std::uint32_t triangle) const {
  if (sums_.empty()) return constant_;
  const std::optional<UvTriangle> uvs = uvs_of(mesh, triangle);
  if (!uvs) return box_mean({{0, columns_}, {0, 0}}, {{0, rows_}, {0, 0}});
  return mean_luminance(*uvs);
}

float EmissionMap::mean_luminance(const UvTriangle& piece) const {
  const glm::vec2 low = glm::min(piece.a, glm::min(piece.b, piece.c));
  const glm::vec2 high = glm::max(piece.a, glm::max(piece.b, piece.c));
  return box_mean(blocks(low.x, high.x, width_, columns_, view_.wrap_u),
                  blocks(low.y, high.y, height_, rows_, view_.wrap_v));
}

}  // namespace lambent
