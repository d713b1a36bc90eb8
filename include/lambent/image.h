// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lambent/error.h"

namespace lambent {

/// A float image: interleaved channels, rows from the top, pixel (0, 0) at the top left.
struct Image {
  int width = 0;              ///< Pixels, >= 0.
  int height = 0;             ///< Pixels, >= 0.
  int channels = 0;           ///< Floats per pixel; 3 is linear Rec. 709 unless noted.
  std::vector<float> pixels;  ///< width * height * channels floats.

  Image() = default;
  /// An image of the given shape, all zero.
  Image(int image_width, int image_height, int image_channels)
      : width(image_width),
        height(image_height),
        channels(image_channels),
        pixels(static_cast<std::size_t>(image_width) * image_height * image_channels) {}

  /// The `channels` floats of pixel (x, y). The pointer lives as long as `pixels` is unchanged.
  float* at(int x, int y) {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
  const float* at(int x, int y) const {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
  /// True where there are no pixels.
  bool empty() const { return pixels.empty(); }
};

/// One named part of a frame, such as "direct". The layer named "" is the whole picture (EXR's
/// R,G,B).
struct Layer {
  std::string name;
  Image image;
};

/// Layers of one size, in the order in which they are written.
struct LayeredImage {
  int width = 0;              ///< Of every layer [pixels].
  int height = 0;             ///< Of every layer [pixels].
  std::vector<Layer> layers;  ///< Their names differ.

  /// The layer of that name, or null. The pointer lives until a layer is added.
  const Image* find(const std::string& name) const;
  Image* find(const std::string& name);
  /// The layer of that name, made (all zero, with that many channels) where it is missing.
  Image& require(const std::string& name, int channels);
};

/// Reads .exr (every layer, float or half), .hdr, .png and .jpg (8 bit, decoded from sRGB to
/// linear). Fails on files that are missing, broken or absurdly large.
Expected<LayeredImage> read_image(const std::string& path);

/// Writes 32-bit float EXR, one channel group per layer ("direct.R"; the layer "" is "R,G,B";
/// one-channel layers are "name.Y"). Writes to a temporary file beside `path` and renames, so no
/// partial file remains.
Expected<void> write_exr(const std::string& path, const LayeredImage& image);

/// Writes an 8-bit PNG of a display-ready image: channels (1, 3 or 4) already encoded, clamped to
/// [0, 1]. As with write_exr, no partial file remains.
Expected<void> write_png(const std::string& path, const Image& display_encoded);

/// Default quality of JPEGs: artefacts are hard to see, and files have a fifth of a PNG's size.
inline constexpr int kJpegQuality = 92;

/// Writes a JPEG of a display-ready image as write_png does, without its alpha: `quality` is 1
/// (smallest) to 100 (best); from 90 on colour keeps its full resolution. No partial file remains.
Expected<void> write_jpeg(const std::string& path, const Image& display_encoded,
                          int quality = kJpegQuality);

}  // namespace lambent
