// SPDX-License-Identifier: Apache-2.0
#include "stream/picture/yuv.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

#include "core/parallel.h"
#include "shared/color.h"

namespace lambent::stream {
namespace {

// ITU-R BT.709-6, item 3.3: differences from luma are divided by these, which scales them to -0.5
// to 0.5
const float kBlueRange = 2.0f * (1.0f - kBlueLuminance);
const float kRedRange = 2.0f * (1.0f - kRedLuminance);
// Item 4.6: limited range in 8 bits
constexpr float kBlack = 16.0f, kBrightnessSteps = 219.0f;
constexpr float kNoColor = 128.0f, kColorSteps = 224.0f;

// Rows of 2x2 blocks per task.
constexpr std::size_t kBlockRowsOfATask = 8;

std::uint8_t rounded(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
}

/// Item 3.2: luma of display-encoded values, with the weights of linear luminance.
float brightness(const float* rgb) {
  return kRedLuminance * rgb[0] + kGreenLuminance * rgb[1] + kBlueLuminance * rgb[2];
}

void convert_block(const Image& display, int x, int y, YuvPicture& yuv) {
  float mean = 0.0f, red = 0.0f, blue = 0.0f;
  for (int i = 0; i < 4; ++i) {
    const int px = x + (i & 1), py = y + (i >> 1);
    const float* rgb = display.at(px, py);
    const float bright = brightness(rgb);
    yuv.y[static_cast<std::size_t>(py) * yuv.width + px] =
        rounded(kBlack + kBrightnessSteps * bright);
    mean += 0.25f * bright;
    red += 0.25f * rgb[0];
    blue += 0.25f * rgb[2];
  }
  const std::size_t at = static_cast<std::size_t>(y / 2) * (yuv.width / 2) + x / 2;
  yuv.cb[at] = rounded(kNoColor + kColorSteps * (blue - mean) / kBlueRange);
  yuv.cr[at] = rounded(kNoColor + kColorSteps * (red - mean) / kRedRange);
}

}  // namespace

void to_yuv(const Image& display, YuvPicture& yuv) {
  assert(display.width % 2 == 0 && display.height % 2 == 0 && display.channels >= 3);
  yuv.width = display.width;
  yuv.height = display.height;
  const std::size_t pixels = static_cast<std::size_t>(yuv.width) * yuv.height;
  yuv.y.resize(pixels);
  yuv.cb.resize(pixels / 4);
  yuv.cr.resize(pixels / 4);
  const auto rows = static_cast<std::size_t>(yuv.height) / 2;
  parallel_chunks(rows, kBlockRowsOfATask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (int x = 0; x < yuv.width; x += 2) {
        convert_block(display, x, static_cast<int>(2 * row), yuv);
      }
    }
  });
}

Image to_display(const YuvPicture& yuv) {
  Image display(yuv.width, yuv.height, 3);
  for (int y = 0; y < yuv.height; ++y) {
    for (int x = 0; x < yuv.width; ++x) {
      const std::size_t color = static_cast<std::size_t>(y / 2) * (yuv.width / 2) + x / 2;
      const float bright =
          (yuv.y[static_cast<std::size_t>(y) * yuv.width + x] - kBlack) / kBrightnessSteps;
      const float blue = bright + kBlueRange * (yuv.cb[color] - kNoColor) / kColorSteps;
      const float red = bright + kRedRange * (yuv.cr[color] - kNoColor) / kColorSteps;
      const float green = (bright - kRedLuminance * red - kBlueLuminance * blue) / kGreenLuminance;
      const glm::vec3 rgb = glm::clamp(glm::vec3(red, green, blue), 0.0f, 1.0f);
      std::copy_n(&rgb.x, 3, display.at(x, y));
    }
  }
  return display;
}

}  // namespace lambent::stream
