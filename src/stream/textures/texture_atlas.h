// SPDX-License-Identifier: Apache-2.0
// Packs all tiles of a field into one picture for a video codec.
//
// The coded signal is sqrt(E), as in LightSignal, divided by a scale that is constant over parts of
// the stream. Red, green and blue are transformed to their mean and two differences, so that equal
// errors in each have about the same effect. Majercik et al. send probes as video textures ("The
// Road to Dynamic Global Illumination", GDC 2019); the signal is that of Lambent's own codec, so
// that errors are comparable.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "lambent/stream.h"
#include "stream/light/geometry.h"

namespace lambent::stream {

/// The places of tiles in the picture: in memory order, row after row.
class TextureAtlas {
 public:
  // Limits of codecs: the largest side, and the block of which sides are multiples [pixels].
  static constexpr int kMaxEdge = 8192, kBlock = 8, kLeastEdge = 64;

  /// Fails where the picture would be too large.
  static Expected<TextureAtlas> of(const FieldGeometry& geometry);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Draws the tiles of lit probes; each other tile is a copy of the one before. `scale` is at
  /// least the root of the largest light [(W/m^2)^(1/2)].
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
