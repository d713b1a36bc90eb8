// SPDX-License-Identifier: Apache-2.0
#include "scenes/png_encoder.h"

#include <new>

#include "core/image/codecs/stb.h"

namespace lambent::scenes {

std::string encode_png(const TextureLevel& image) {
  constexpr int kMaxChannels = 4;
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  bool opaque = true;
  for (std::size_t i = 0; i < pixels && opaque; ++i) {
    opaque = image.rgba[kMaxChannels * i + 3] == 255;
  }
  const int channels = opaque ? 3 : kMaxChannels;
  std::vector<std::uint8_t> packed(pixels * channels);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (int c = 0; c < channels; ++c) packed[channels * i + c] = image.rgba[kMaxChannels * i + c];
  }
  std::string png;
  const auto append = [](void* out, void* data, int size) {
    static_cast<std::string*>(out)->append(static_cast<const char*>(data), size);
  };
  if (stbi_write_png_to_func(append, &png, image.width, image.height, channels, packed.data(),
                             image.width * channels) == 0) {
    throw std::bad_alloc();
  }
  return png;
}

}  // namespace lambent::scenes
