// SPDX-License-Identifier: Apache-2.0
// The layers of a frame; docs/overview.md shows them.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <iterator>

#include "lambent/image.h"

namespace lambent {

struct LayerShape {
  const char* name;
  int channels;
};

/// The layers in the order of RenderedFrame::image.
inline constexpr LayerShape kFrameLayers[] = {
    {"", 3},       {"direct", 3},       {"indirect", 3}, {"irradiance", 3},
    {"glossy", 3}, {"transmission", 3}, {"emission", 3}, {"fog", 3},
    {"albedo", 3}, {"normal", 3},       {"position", 3}, {"depth", 1}};

/// Gives an image exactly these layers. Reuses their memory, whose contents are undefined.
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

/// The frame's layers, with quick access to each.
struct Layers {
  explicit Layers(LayeredImage& image)
      : all(image, "", 3),
        direct(image, "direct", 3),
        indirect(image, "indirect", 3),
        irradiance(image, "irradiance", 3),
        glossy(image, "glossy", 3),
        transmission(image, "transmission", 3),
        emission(image, "emission", 3),
        fog(image, "fog", 3),
        albedo(image, "albedo", 3),
        normal(image, "normal", 3),
        position(image, "position", 3),
        depth(image, "depth", 1) {}

  /// A layer's floats. Their address stays valid when further layers are made.
  struct Pixels {
    Pixels(LayeredImage& image, const char* name, int channels)
        : data(image.require(name, channels).pixels.data()) {}
    float* data;
  };
  Pixels all, direct, indirect, irradiance, glossy, transmission, emission, fog, albedo, normal,
      position, depth;
};

inline void add(Layers::Pixels& layer, std::size_t pixel, const glm::vec3& value) {
  for (int c = 0; c < 3; ++c) layer.data[3 * pixel + c] += value[c];
}

}  // namespace lambent
