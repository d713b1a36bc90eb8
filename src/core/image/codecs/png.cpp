// SPDX-License-Identifier: Apache-2.0
// PNG and JPEG: 8 bits a channel, sRGB.
#include <string_view>

#include "core/byte_decoding.h"
#include "core/image/codecs/decode_stb.h"
#include "core/image/codecs/stb.h"
#include "shared/color.h"

namespace lambent {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPngMagic = "\x89PNG\r\n\x1a\n"sv;
constexpr std::string_view kJpegMagic = "\xff\xd8\xff"sv;

std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::uint8_t quantise(float value) {
  constexpr float kWhite = 255.0f;
  return value > 0.0f ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0f) * kWhite)) : 0;
}

bool is_png_or_jpeg(ByteView bytes) {
  return text_of(bytes).starts_with(kPngMagic) || text_of(bytes).starts_with(kJpegMagic);
}

Expected<LayeredImage> decode_png_or_jpeg(const std::string& path, ByteView bytes) {
  const Expected<ImageHeader> header = read_stb_header(path, bytes);
  if (!header) return tl::unexpected(header.error());
  const bool grey_with_alpha = header->channels == 2;
  const int channels = grey_with_alpha ? 4 : header->channels;
  const Expected<StbPixels> pixels = decode_stb_bytes(path, bytes, channels);
  if (!pixels) return tl::unexpected(pixels.error());

  const ByteDecoding& linear = srgb_byte_decoding();
  LayeredImage result{header->width, header->height, {}};
  Image& image = result.require("", channels);
  const std::size_t step = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t value = pixels->get()[i];
    const bool alpha = i % step == 3;
    image.pixels[i] = alpha ? static_cast<float>(value) / 255.0f : linear[value];
  }
  return result;
}

}  // namespace lambent
