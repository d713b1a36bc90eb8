// SPDX-License-Identifier: Apache-2.0
// How bright each part of an emissive texture is, for lights to be drawn by their power.
#pragma once

#include <cstdint>
#include <vector>

#include "lambent/scene.h"

namespace lambent {

/// The emitted luminance of a material, summed over blocks of texels so that any box's mean is
/// found at once. Based on: Crow, "Summed-Area Tables for Texture Mapping", SIGGRAPH 1984.
class EmissionMap {
 public:
  /// Reads the texture that the material emits through; nothing where it does not emit.
  EmissionMap(const Scene& scene, const Material& material);

  /// Mean luminance [W/(m^2 sr)] of the box around the triangle's texture coordinates, without
  /// vertex colours. More than 0 wherever a texel that a filtered lookup in the triangle can touch
  /// emits.
  float mean_luminance(const Mesh& mesh, std::uint32_t triangle) const;

 private:
  struct BlockRange {
    int first, last;  // half open
  };
  BlockRange blocks(float low, float high, int texels, int count, Wrap wrap) const;
  float box_mean(BlockRange x, BlockRange y) const;

  float constant_ = 0.0f;  // luminance where there is no texture
  float unit_ = 0.0f;      // luminance that one step of the sums stands for
  TextureView view_;
  int width_ = 0, height_ = 0;  // [texels]
  int columns_ = 0, rows_ = 0;  // [blocks]
  std::vector<std::uint64_t>
      sums_;  // (columns_ + 1) * (rows_ + 1): over all blocks above and to the left
};

}  // namespace lambent
