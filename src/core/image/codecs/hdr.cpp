// SPDX-License-Identifier: Apache-2.0
// Based on: Ward, "Real Pixels", Graphics Gems II, 1991, and the Radiance file format (.hdr, RGBE).
// A reader of our own, since that of stb_image (2.27) does not terminate on some truncated files.
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "core/image/codecs/formats.h"

namespace lambent {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Scanlines outside this range of widths are never run-length encoded in the newer way.
constexpr int kMinRleWidth = 8;
constexpr int kMaxRleWidth = 0x7fff;
/// A count above this starts a run of one value; a count up to it, that many literal values.
constexpr int kMaxLiteralCount = 128;
/// Exponent bias of the format (128) plus the 8 bits of the mantissa.
constexpr int kExponentBias = 128 + 8;

/// Reads bytes one by one; records an attempt to read past the end.
struct Cursor {
  ByteView bytes;
  std::size_t position = 0;

  bool take(std::uint8_t& value) {
    if (position >= bytes.size()) return false;
    value = static_cast<std::uint8_t>(bytes[position++]);
    return true;
  }
  bool take(Rgbe& pixel) {
    for (std::uint8_t& part : pixel) {
      if (!take(part)) return false;
    }
    return true;
  }
  bool take_line(std::string& line) {
    line.clear();
    std::uint8_t c = 0;
    while (take(c)) {
      if (c == '\n') return true;
      line.push_back(static_cast<char>(c));
    }
    return false;
  }
};

enum class Decoded { ok, truncated, bad_run };

const char* cause_of(Decoded decoded) {
  return decoded == Decoded::truncated ? "the file is truncated"
                                       : "broken HDR: run beyond its scanline";
}

/// The four planes of a scanline, each a sequence of runs and literals.
Decoded read_rle_scanline(Cursor& cursor, std::vector<Rgbe>& row) {
  for (std::size_t plane = 0; plane < 4; ++plane) {
    std::size_t x = 0;
    while (x < row.size()) {
      std::uint8_t count = 0, value = 0;
      if (!cursor.take(count)) return Decoded::truncated;
      const bool run = count > kMaxLiteralCount;
      const std::size_t length = run ? count - kMaxLiteralCount : count;
      if (length == 0 || length > row.size() - x) return Decoded::bad_run;
      for (std::size_t i = 0; i < length; ++i) {
        if ((!run || i == 0) && !cursor.take(value)) return Decoded::truncated;
        row[x++][plane] = value;
      }
    }
  }
  return Decoded::ok;
}

/// Reads pixel after pixel, beginning with the already read `pixel`, with the oldest kind of runs:
/// (1, 1, 1, n) repeats the last pixel n times; several in a row are the digits, base 256, of a
/// longer run.
Decoded read_flat_scanline(Cursor& cursor, Rgbe pixel, std::vector<Rgbe>& row) {
  std::size_t x = 0;
  int shift = 0;
  for (;;) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const std::size_t length = shift < 24 ? std::size_t{pixel[3]} << shift : row.size() + 1;
      if (x == 0 || length > row.size() - x) return Decoded::bad_run;
      for (std::size_t i = 0; i < length; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    } else {
      row[x++] = pixel;
      shift = 0;
    }
    if (x >= row.size()) return Decoded::ok;
    if (!cursor.take(pixel)) return Decoded::truncated;
  }
}

Decoded read_scanline(Cursor& cursor, std::vector<Rgbe>& row) {
  Rgbe first{};
  if (!cursor.take(first)) return Decoded::truncated;
  const int width = static_cast<int>(row.size());
  const bool rle = width >= kMinRleWidth && width <= kMaxRleWidth && first[0] == 2 &&
                   first[1] == 2 && (first[2] << 8 | first[3]) == width;
  return rle ? read_rle_scanline(cursor, row) : read_flat_scanline(cursor, first, row);
}

/// Reads up to the pixels. Returns the cause of failure, or null.
const char* read_header(Cursor& cursor, int& width, int& height) {
  std::string line;
  cursor.take_line(line);
  do {
    if (!cursor.take_line(line)) return "the file is truncated";
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
      return "unsupported HDR: only FORMAT=32-bit_rle_rgbe is";
    }
  } while (!line.empty());
  if (!cursor.take_line(line)) return "the file is truncated";
  if (std::sscanf(line.c_str(), "-Y %9d +X %9d", &height, &width) != 2) {
    return "unsupported HDR: its size must read \"-Y height +X width\"";
  }
  return nullptr;
}

}  // namespace

bool is_hdr(ByteView bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with("#?RADIANCE\n") || text.starts_with("#?RGBE\n");
}

Expected<LayeredImage> decode_hdr(const std::string& path, ByteView bytes) {
  Cursor cursor{bytes};
  int width = 0, height = 0;
  if (const char* cause = read_header(cursor, width, height)) return fail(path, "", cause);
  if (const auto ok = check_image_size(path, width, height, 3); !ok)
    return tl::unexpected(ok.error());
  // A scanline takes at least four bytes: one pixel, or the header of its runs.
  if (bytes.size() / sizeof(Rgbe) < static_cast<std::size_t>(height)) {
    return fail(path, "", "the file is truncated");
  }

  LayeredImage result{width, height, {}};
  Image& image = result.require("", 3);
  std::vector<Rgbe> row(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    if (const Decoded decoded = read_scanline(cursor, row); decoded != Decoded::ok) {
      return fail(path, "scanline " + std::to_string(y), cause_of(decoded));
    }
    for (int x = 0; x < width; ++x) {
      const Rgbe& pixel = row[static_cast<std::size_t>(x)];
      const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, pixel[3] - kExponentBias);
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = scale * pixel[static_cast<std::size_t>(c)];
    }
  }
  return result;
}

}  // namespace lambent
