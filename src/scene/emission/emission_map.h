// SPDX-License-Identifier: Apache-2.0
// The mean brightness of any part of an emissive texture, so that lights can be drawn by their
// power.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "lambent/scene.h"

namespace lambent {

/// Texture coordinates of the corners of a triangle, or of a piece of one, in its emissive texture.
struct UvTriangle {
  glm::vec2 a, b, c;
};

/// A summed-area table of a material's emitted luminance over blocks of texels, from which the mean
/// over any box is found in constant time. Based on: Crow, "Summed-Area Tables for Texture
/// Mapping", SIGGRAPH 1984.
class EmissionMap {
 public:
  /// Reads the material's emissive texture, if it emits and has one.
  EmissionMap(const Scene& scene, const Material& material);

  /// Mean luminance [W/(m^2 sr)] of the box around the triangle's texture coordinates, without
  /// vertex colours. It is more than 0 if any texel emits that a filtered lookup in the triangle
  /// can touch.
  float mean_luminance(const Mesh& mesh, std::uint32_t triangle) const;
  /// Mean luminance [W/(m^2 sr)] of the box around a piece of a triangle, as above.
  float mean_luminance(const UvTriangle& piece) const;

  /// Returns the texture coordinates of a triangle, or nothing if it emits uniformly.
  std::optional<UvTriangle> uvs_of(const Mesh& mesh, std::uint32_t triangle) const;

  /// Returns how often a piece of a triangle can be halved while it still covers more of the
  /// texture than the filter's radius adds to the box around it.
  int useful_halvings(const UvTriangle& piece) const;

 private:
  /// The blocks from `first` on, up to and without `last`.
  struct BlockRange {
    int first, last;
  };
  /// The blocks of an interval of texture coordinates. One that crosses an edge of the texture
  /// continues from the opposite edge; the blocks there are the `rest`.
  struct WrappedRange {
    BlockRange range, rest;
  };
  WrappedRange blocks(float low, float high, int texels, int count, Wrap wrap) const;
  std::uint64_t box_sum(BlockRange x, BlockRange y) const;
  float box_mean(const WrappedRange& x, const WrappedRange& y) const;

  float constant_ = 0.0f;  // luminance of the material without its texture [W/(m^2 sr)]
  float unit_ = 0.0f;      // luminance of one step of the sums [W/(m^2 sr)]
  TextureView view_;
  int width_ = 0, height_ = 0;  // [texels]
  int block_ = 1;               // width and height of a block [texels]
  int columns_ = 0, rows_ = 0;  // [blocks]
  // The summed-area table, of (columns_ + 1) * (rows_ + 1) sums: each is over all blocks above and
  // to the left of it.
  std::vector<std::uint64_t> sums_;
};

}  // namespace lambent
