// SPDX-License-Identifier: Apache-2.0
// How bright an emissive texture is in any place, for lights to be drawn by their power.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "lambent/scene.h"

namespace lambent {

/// Corners of a triangle, or of a piece of one, in the texture that it emits through.
struct UvTriangle {
  glm::vec2 a, b, c;
};

/// The emitted luminance of a material, summed over blocks of texels so that any box's mean is
/// found at once. Based on: Crow, "Summed-Area Tables for Texture Mapping", SIGGRAPH 1984.
class EmissionMap {
 public:
  /// Reads the texture that the material emits through, if it emits and has one.
  EmissionMap(const Scene& scene, const Material& material);

  /// Mean luminance [W/(m^2 sr)] of the box around the triangle's texture coordinates, without
  /// vertex colours. It is more than 0 if any texel emits that a filtered lookup in the triangle
  /// can touch.
  float mean_luminance(const Mesh& mesh, std::uint32_t triangle) const;
  /// Mean luminance [W/(m^2 sr)] of the box around a piece of a triangle, as above.
  float mean_luminance(const UvTriangle& piece) const;

  /// Returns where a triangle reads the texture, or nothing if it emits the same all over.
  std::optional<UvTriangle> uvs_of(const Mesh& mesh, std::uint32_t triangle) const;

  /// Returns how often a piece of a triangle can be halved and still show more of the texture than
  /// the box around it adds.
  int useful_halvings(const UvTriangle& piece) const;

 private:
  /// The blocks from `first` on, up to and without `last`.
  struct BlockRange {
    int first, last;
  };
  /// The blocks of an interval of texture coordinates. One that crosses an edge of the texture goes
  /// on from the opposite edge: the blocks there are the `rest`.
  struct WrappedRange {
    BlockRange range, rest;
  };
  WrappedRange blocks(float low, float high, int texels, int count, Wrap wrap) const;
  std::uint64_t box_sum(BlockRange x, BlockRange y) const;
  float box_mean(const WrappedRange& x, const WrappedRange& y) const;

  float constant_ = 0.0f;  // luminance of the material but for its texture [W/(m^2 sr)]
  float unit_ = 0.0f;      // luminance that one step of the sums stands for [W/(m^2 sr)]
  TextureView view_;
  int width_ = 0, height_ = 0;  // [texels]
  int block_ = 1;               // width and height of a block [texels]
  int columns_ = 0, rows_ = 0;  // [blocks]
  // The summed-area table, of (columns_ + 1) * (rows_ + 1) sums: each is over all blocks above and
  // to the left of it.
  std::vector<std::uint64_t> sums_;
};

}  // namespace lambent
