// SPDX-License-Identifier: Apache-2.0
// All tiles of a field as one picture for a video codec.
//
// What is coded is sqrt(E), as in LightSignal, over the largest of a stretch of the stream. Red,
// green and blue of it become their mean and two differences, of which an error counts about the
// same in each. Majercik et al. send probes as video textures ("The Road to Dynamic Global
// Illumination", GDC 2019); the domain is that of our own codec, so that errors are of one kind.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "lambent/stream.h"
#include "stream/light/geometry.h"

namespace lambent::stream {

/// Where tiles are in the picture: in the order of memory, row after row.
class TextureAtlas {
 public:
  // Codecs take no larger pictures, and in whole blocks [pixels].
  static constexpr int kMaxEdge = 8192, kBlock = 8, kLeastEdge = 64;

  /// Fails where the picture would be too large.
  static Expected<TextureAtlas> of(const FieldGeometry& geometry);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Draws the tiles of lit probes; others are as the one before. `scale` is at least the root of
  /// the largest light [(W/m^2)^(1/2)].
  void draw(const LightLayout& layout, std::span<const glm::vec4> tiles, float scale,
            TexturePicture& picture) const;
  /// The tiles of a picture of the atlas' size.
  std::vector<glm::vec4> tiles_of(const TexturePicture& picture, float scale) const;

 private:
  TextureAtlas(int probes, int edge, int tiles_in_row);
  std::size_t pixel(int probe, int texel) const;

  int probes_, edge_, tiles_in_row_, width_, height_;
};

}  // namespace lambent::stream
