// SPDX-License-Identifier: Apache-2.0
#include "lambent/image.h"

#include <cassert>

namespace lambent {

const Image* LayeredImage::find(const std::string& name) const {
  for (const Layer& layer : layers) {
    if (layer.name == name) return &layer.image;
  }
  return nullptr;
}

Image* LayeredImage::find(const std::string& name) {
  for (Layer& layer : layers) {
    if (layer.name == name) return &layer.image;
  }
  return nullptr;
}

Image& LayeredImage::require(const std::string& name, int channels) {
  if (Image* existing = find(name)) {
    assert(existing->channels == channels);
    return *existing;
  }
  layers.push_back({name, Image(width, height, channels)});
  return layers.back().image;
}

}  // namespace lambent
