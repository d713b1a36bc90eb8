// SPDX-License-Identifier: Apache-2.0
#include "compose/adaptive/layers_so_far.h"

#include "compose/frame_tasks.h"
#include "core/parallel.h"
#include "shared/color.h"

namespace lambent {

void read_luminances(const LayeredImage& frame, std::vector<float>& luminances) {
  const std::vector<float>& picture = frame.find("")->pixels;
  luminances.resize(picture.size() / 3);
  parallel_chunks(luminances.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      luminances[i] = luminance(vec3(picture[3 * i], picture[3 * i + 1], picture[3 * i + 2]));
    }
  });
}

void scale_layers(std::span<const std::uint8_t> skipped, float scale, LayeredImage& frame) {
  for (Layer& layer : frame.layers) {
    const auto channels = static_cast<std::size_t>(layer.image.channels);
    std::vector<float>& values = layer.image.pixels;
    parallel_chunks(skipped.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin * channels; i < end * channels; ++i) {
        if (skipped[i / channels] == 0) values[i] *= scale;
      }
    });
  }
}

}  // namespace lambent
