// SPDX-License-Identifier: Apache-2.0
// One reader per image format, from bytes to images; files.cpp chooses among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lambent/image.h"

namespace lambent {

using ByteView = std::span<const std::byte>;

/// Images wider or higher than this [pixels] are refused before anything is allocated.
inline constexpr int kMaxImageSide = 1 << 16;
/// Images (all layers together) of more floats than this are refused: 2 GiB, an 8k frame of 14 RGB
/// layers.
inline constexpr std::uint64_t kMaxImageFloats = std::uint64_t{1} << 29;

/// The limit of floats for EXR files, of which small ones cannot decode to large images (16 GiB, a
/// 16k frame of 5 RGB layers).
inline constexpr std::uint64_t kMaxExrFloats = std::uint64_t{1} << 32;

/// Fails, naming `path`, unless an image of that shape is not empty and its sides are within the
/// limit. This is the only limit for images that are written.
Expected<void> check_image_sides(const std::string& path, std::int64_t width, std::int64_t height,
                                 std::int64_t channels);

/// Fails, naming `path`, unless an image has the pixels that its size asks for.
Expected<void> check_pixels_fill_size(const std::string& path, const Image& image);

/// Fails, naming `path`, unless an image of that shape is not empty, within the limits, and fits
/// into memory.
Expected<void> check_image_size(const std::string& path, std::int64_t width, std::int64_t height,
                                std::int64_t channels, std::uint64_t max_floats = kMaxImageFloats);

bool is_exr(ByteView bytes);
bool is_hdr(ByteView bytes);
bool is_png_or_jpeg(ByteView bytes);

/// `path` only names the file in errors.
Expected<LayeredImage> decode_exr(const std::string& path, ByteView bytes);
Expected<LayeredImage> decode_hdr(const std::string& path, ByteView bytes);
/// 8-bit sRGB colour becomes linear; alpha is linear already. One, three or four channels.
Expected<LayeredImage> decode_png_or_jpeg(const std::string& path, ByteView bytes);

/// Rounds to the nearest of 256 levels between 0 and 1; NaN becomes 0.
std::uint8_t quantise(float value);

}  // namespace lambent
