// SPDX-License-Identifier: Apache-2.0
#include "scene/image_decode.h"

#include <webp/decode.h>

#include <climits>
#include <cstring>
#include <string>

#include "core/image/codecs/decode_stb.h"
#include "core/image/codecs/stb.h"

namespace lambent {
namespace {

enum class Format { unknown, png, jpeg, webp, ktx2 };

Format format_of(std::span<const std::uint8_t> bytes) {
  const auto starts = [&bytes](std::size_t offset, const char* magic, std::size_t length) {
    return bytes.size() >= offset + length &&
           std::memcmp(bytes.data() + offset, magic, length) == 0;
  };
  if (starts(0, "\x89PNG\r\n\x1a\n", 8)) return Format::png;
  if (starts(0, "\xff\xd8\xff", 3)) return Format::jpeg;
  if (starts(0, "RIFF", 4) && starts(8, "WEBP", 4)) return Format::webp;
  if (starts(0, "\xabKTX 20\xbb", 8)) return Format::ktx2;
  return Format::unknown;
}

bool absurd(int width, int height) {
  return width < 1 || height < 1 || width > kMaxTextureSize || height > kMaxTextureSize;
}

std::size_t rgba_bytes(int width, int height) {
  return static_cast<std::size_t>(width) * height * 4;
}

// The decoder's error on this thread; a general message where it has none.
std::string broken(Format format) {
  const char* reason = format == Format::webp ? nullptr : stbi_failure_reason();
  const std::string cause = "the image is corrupt or truncated";
  return reason ? cause + " (" + reason + ")" : cause;
}

}  // namespace

Expected<TextureLevel> decode_image(std::span<const std::uint8_t> bytes, const std::string& file,
                                    const std::string& place) {
  const Format format = format_of(bytes);
  if (format == Format::unknown) return fail(file, place, "the image is not PNG, JPEG or WebP");
  if (format == Format::ktx2) {
    return fail(file, place, "the image is KTX2; convert it to PNG, JPEG or WebP");
  }
  if (bytes.size() > INT_MAX) return fail(file, place, "the image file is absurdly large");
  const int size = static_cast<int>(bytes.size());
  if (format != Format::webp && !is_safe_for_stb(std::as_bytes(bytes))) {
    return fail(file, place, "the image is corrupt (impossible Huffman tables)");
  }

  // Read the dimensions first, so that nothing is allocated for absurd ones
  TextureLevel level;
  int channels = 0;
  const bool readable =
      format == Format::webp
          ? WebPGetInfo(bytes.data(), bytes.size(), &level.width, &level.height) != 0
          : stbi_info_from_memory(bytes.data(), size, &level.width, &level.height, &channels) != 0;
  if (!readable) return fail(file, place, broken(format));
  if (absurd(level.width, level.height)) {
    return fail(file, place,
                "the image's size of " + std::to_string(level.width) + " x " +
                    std::to_string(level.height) + " exceeds " + std::to_string(kMaxTextureSize));
  }

  if (format == Format::webp) {
    level.rgba.resize(rgba_bytes(level.width, level.height));
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), level.rgba.data(), level.rgba.size(),
                            level.width * 4)) {
      return fail(file, place, broken(format));
    }
    return level;
  }
  constexpr int kRgba = 4;
  const Expected<StbPixels> pixels = decode_stb_bytes(file, std::as_bytes(bytes), kRgba);
  if (!pixels) {
    return fail(file, place, "the image is corrupt or truncated (" + pixels.error().cause + ")");
  }
  const std::uint8_t* first = pixels->get();
  level.rgba.assign(first, first + rgba_bytes(level.width, level.height));
  return level;
}

}  // namespace lambent
