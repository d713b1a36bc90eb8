// SPDX-License-Identifier: Apache-2.0
// Pictures as video codecs take them: BT.709 in limited range, colour at half the resolution.
#pragma once

#include <cstdint>
#include <vector>

#include "lambent/image.h"

namespace lambent::stream {

/// Brightness and two colour differences, 8 bits each (I420). Width and height are even.
struct YuvPicture {
  int width = 0, height = 0;         ///< [pixels]
  std::vector<std::uint8_t> y;       ///< width * height, 16 to 235.
  std::vector<std::uint8_t> cb, cr;  ///< width / 2 * height / 2 each, 16 to 240.
};

/// A display-ready picture (core/image/tone_map.h) of at least three channels and even sides; into
/// a picture whose memory is used again. Runs on all cores.
void to_yuv(const Image& display, YuvPicture& yuv);

/// The display-ready picture that a decoder's output shows, three channels in [0, 1].
Image to_display(const YuvPicture& yuv);

}  // namespace lambent::stream
