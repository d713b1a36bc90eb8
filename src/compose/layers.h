// SPDX-License-Identifier: Apache-2.0
// The layers of a frame; docs/overview.md shows them.
#pragma once

#include <cstddef>
#include <iterator>

#include "lambent/image.h"

namespace lambent {

struct LayerShape {
  const char* name;
  int channels;
};

/// In the order of RenderedFrame::image.
inline constexpr LayerShape kFrameLayers[] = {
    {"", 3},         {"direct", 3}, {"indirect", 3}, {"irradiance", 3}, {"glossy", 3},
    {"emission", 3}, {"albedo", 3}, {"normal", 3},   {"position", 3},   {"depth", 1}};

/// Gives an image these layers and no others. Their memory is used again, and holds anything.
inline void shape_layers(int width, int height, LayeredImage& image) {
  image.width = width;
  image.height = height;
  image.layers.resize(std::size(kFrameLayers));
  for (std::size_t i = 0; i < image.layers.size(); ++i) {
    Layer& layer = image.layers[i];
    layer.name = kFrameLayers[i].name;
    layer.image.width = width;
    layer.image.height = height;
    layer.image.channels = kFrameLayers[i].channels;
    layer.image.pixels.resize(static_cast<std::size_t>(width) * height * layer.image.channels);
  }
}

}  // namespace lambent
