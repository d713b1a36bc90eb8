// SPDX-License-Identifier: Apache-2.0
// Decoding from memory with stb_image, with detection of truncated files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/image/codecs/formats.h"

namespace lambent {

/// The header of an image file.
struct ImageHeader {
  int width = 0, height = 0;
  int channels = 0;  ///< In the file: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
};

using StbPixels = std::unique_ptr<std::uint8_t, void (*)(void*)>;

/// Whether it is safe to decode a PNG or JPEG with stb_image: version 2.27 (Debian 12) writes
/// beyond its tables where a JPEG declares more than 256 Huffman codes. Call it before any other
/// function of stb_image.
bool is_safe_for_stb(ByteView bytes);

/// The size of a PNG or JPEG, checked against the limits.
Expected<ImageHeader> read_stb_header(const std::string& path, ByteView bytes);

/// All pixels of a PNG or JPEG, `channels` bytes each, rows from the top. Fails on truncated files.
Expected<StbPixels> decode_stb_bytes(const std::string& path, ByteView bytes, int channels);

}  // namespace lambent
