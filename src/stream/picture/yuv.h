// SPDX-License-Identifier: Apache-2.0
// Pictures in the format of video codecs: BT.709 in limited range, with chroma at half the
// resolution.
#pragma once

#include <cstdint>
#include <vector>

#include "lambent/image.h"

namespace lambent::stream {

/// Luma and two chroma planes, 8 bits each (I420). Width and height are even.
struct YuvPicture {
  int width = 0, height = 0;         ///< [pixels]
  std::vector<std::uint8_t> y;       ///< width * height, 16 to 235.
  std::vector<std::uint8_t> cb, cr;  ///< width / 2 * height / 2 each, 16 to 240.
};

/// Converts a display-ready picture (core/image/tone_map.h) with at least three channels and even
/// sides. Reuses the memory of `yuv`. Runs on all cores.
void to_yuv(const Image& display, YuvPicture& yuv);

/// Converts a decoder's output to a display-ready picture, three channels in [0, 1].
Image to_display(const YuvPicture& yuv);

}  // namespace lambent::stream
