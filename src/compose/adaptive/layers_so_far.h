// SPDX-License-Identifier: Apache-2.0
// The layers of a picture that has some of its samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lambent/image.h"

namespace lambent {

/// Stores the luminances of the picture's pixels, row after row.
void read_luminances(const LayeredImage& frame, std::vector<float>& luminances);

/// Multiplies all layers of the pixels that `skipped` does not mark with 1; it has an entry a
/// pixel.
void scale_layers(std::span<const std::uint8_t> skipped, float scale, LayeredImage& frame);

}  // namespace lambent
