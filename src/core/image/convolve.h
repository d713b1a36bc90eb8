// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lambent/image.h"

namespace lambent {

/// A one-dimensional filter: taps at offsets -radius to +radius.
struct Kernel {
  int radius = 0;
  std::vector<float> taps;  ///< 2 * radius + 1 weights.
};

/// exp(-x^2 / (2 sigma^2)) at offsets up to `radius` [pixels], scaled to sum 1.
Kernel gaussian_kernel(float sigma, int radius);

/// `image` filtered by `horizontal`, then by `vertical`; pixels beyond the border repeat it. All
/// channels are filtered alike.
Image convolve(const Image& image, const Kernel& horizontal, const Kernel& vertical);

}  // namespace lambent
