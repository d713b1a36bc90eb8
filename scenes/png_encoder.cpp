// SPDX-License-Identifier: Apache-2.0
#include "scenes/png_encoder.h"

#include <cstdlib>
#include <new>

// The library has its own copy; this one stays within this file.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

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
  int size = 0;
  unsigned char* bytes = stbi_write_png_to_mem(packed.data(), image.width * channels, image.width,
                                               image.height, channels, &size);
  if (bytes == nullptr) throw std::bad_alloc();
  std::string png(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return png;
}

}  // namespace lambent::scenes
