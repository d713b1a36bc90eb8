// SPDX-License-Identifier: Apache-2.0
#include "core/image/convolve.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace lambent {
namespace {

/// Rows that one thread filters at a time.
constexpr std::size_t kRowsPerChunk = 16;

/// body(y) for every row, on all cores.
template <class Body>
void for_each_row(int height, const Body& body) {
  parallel_chunks(static_cast<std::size_t>(height), kRowsPerChunk,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
                  });
}

/// out[i] += weight * in[i]
void add_scaled(float* out, const float* in, std::size_t count, float weight) {
  for (std::size_t i = 0; i < count; ++i) out[i] += weight * in[i];
}

void filter_row(const float* in, float* out, int width, int channels, const Kernel& kernel) {
  for (int x = 0; x < width; ++x) {
    for (int k = -kernel.radius; k <= kernel.radius; ++k) {
      const int from = std::clamp(x + k, 0, width - 1);
      const float weight = kernel.taps[static_cast<std::size_t>(k + kernel.radius)];
      for (int c = 0; c < channels; ++c) out[x * channels + c] += weight * in[from * channels + c];
    }
  }
}

}  // namespace

Kernel gaussian_kernel(float sigma, int radius) {
  Kernel kernel{radius, {}};
  float sum = 0.0f;
  for (int x = -radius; x <= radius; ++x) {
    const float offset = static_cast<float>(x) / sigma;
    kernel.taps.push_back(std::exp(-0.5f * offset * offset));
    sum += kernel.taps.back();
  }
  for (float& tap : kernel.taps) tap /= sum;
  return kernel;
}

Image convolve(const Image& image, const Kernel& horizontal, const Kernel& vertical) {
  Image rows(image.width, image.height, image.channels);
  for_each_row(image.height, [&](int y) {
    filter_row(image.at(0, y), rows.at(0, y), image.width, image.channels, horizontal);
  });

  Image result(image.width, image.height, image.channels);
  const std::size_t row_floats = static_cast<std::size_t>(image.width) * image.channels;
  for_each_row(image.height, [&](int y) {
    for (int k = -vertical.radius; k <= vertical.radius; ++k) {
      const int from = std::clamp(y + k, 0, image.height - 1);
      add_scaled(result.at(0, y), rows.at(0, from), row_floats,
                 vertical.taps[static_cast<std::size_t>(k + vertical.radius)]);
    }
  });
  return result;
}

}  // namespace lambent
