// SPDX-License-Identifier: Apache-2.0
#include "core/image/codecs/decode_stb.h"

#include <algorithm>
#include <cstring>

#include "core/image/codecs/stb.h"

namespace lambent {
namespace {

/// stb_image continues with zeros where a file ends; this reader records that it was asked for
/// more.
struct Reader {
  ByteView bytes;
  std::size_t position = 0;
  bool asked_beyond_end = false;
};

/// stb_image fills its buffer in steps of this many bytes, and only when it needs at least one
/// more.
constexpr int kStbBufferBytes = 128;

int read_some(void* user, char* data, int size) {
  Reader& reader = *static_cast<Reader*>(user);
  const std::size_t left = reader.bytes.size() - reader.position;
  const std::size_t count =
      std::min<std::size_t>(left, static_cast<std::size_t>(std::max(size, 0)));
  const bool exact_request = size != kStbBufferBytes;
  if (count == 0 || (exact_request && static_cast<int>(count) < size))
    reader.asked_beyond_end = true;
  std::memcpy(data, reader.bytes.data() + reader.position, count);
  reader.position += count;
  return static_cast<int>(count);
}

void skip_some(void* user, int count) {
  Reader& reader = *static_cast<Reader*>(user);
  const std::int64_t target = static_cast<std::int64_t>(reader.position) + count;
  const std::int64_t end = static_cast<std::int64_t>(reader.bytes.size());
  if (target > end) reader.asked_beyond_end = true;
  reader.position = static_cast<std::size_t>(std::clamp<std::int64_t>(target, 0, end));
}

int at_end(void* user) {
  const Reader& reader = *static_cast<const Reader*>(user);
  return reader.position >= reader.bytes.size() ? 1 : 0;
}

constexpr stbi_io_callbacks kCallbacks = {read_some, skip_some, at_end};

std::string stb_cause(const Reader& reader) {
  if (reader.asked_beyond_end) return "the file is truncated";
  const char* reason = stbi_failure_reason();
  return std::string("cannot be decoded: ") + (reason != nullptr ? reason : "unknown reason");
}

// ITU-T T.81, Annex B: the markers that matter here.
constexpr std::uint8_t kMarkerStart = 0xff;
constexpr std::uint8_t kHuffmanTables = 0xc4;    // DHT
constexpr std::uint8_t kLastFrame = 0xc2;        // SOF0 to SOF2
constexpr std::uint8_t kQuantisation = 0xdb;     // DQT
constexpr std::uint8_t kRestartInterval = 0xdd;  // DRI
constexpr std::uint8_t kFirstApplication = 0xe0, kLastApplication = 0xef, kComment = 0xfe;

/// A Huffman table's class and number (1 byte), and its number of codes of each length (16 bytes).
constexpr std::size_t kTableHeadBytes = 17;
constexpr std::size_t kMaxHuffmanCodes = 256;

std::uint8_t byte_at(ByteView bytes, std::size_t i) {
  return i < bytes.size() ? static_cast<std::uint8_t>(bytes[i]) : std::uint8_t{0};
}

std::size_t length_at(ByteView bytes, std::size_t i) {
  return static_cast<std::size_t>(byte_at(bytes, i)) << 8 | byte_at(bytes, i + 1);
}

/// Whether every table of the DHT segment whose length field is at `i` has a valid number of codes.
bool huffman_tables_fit(ByteView bytes, std::size_t i) {
  const std::size_t end = std::min(i + length_at(bytes, i), bytes.size());
  for (i += 2; i < end;) {
    std::size_t codes = 0;
    for (std::size_t k = 1; k < kTableHeadBytes; ++k) codes += byte_at(bytes, i + k);
    if (codes > kMaxHuffmanCodes) return false;
    i += kTableHeadBytes + codes;
  }
  return true;
}

bool has_length(std::uint8_t marker) {
  return (marker >= 0xc0 && marker <= kLastFrame) || marker == kHuffmanTables ||
         marker == kQuantisation || marker == kRestartInterval || marker == kComment ||
         (marker >= kFirstApplication && marker <= kLastApplication);
}

}  // namespace

bool is_safe_for_stb(ByteView bytes) {
  if (byte_at(bytes, 0) != kMarkerStart) return true;  // A PNG.

  // Walk the segments before the first scan, so that metadata is not mistaken for tables
  std::size_t i = 2;
  while (i < bytes.size()) {
    while (i < bytes.size() && byte_at(bytes, i) != kMarkerStart) ++i;
    while (i < bytes.size() && byte_at(bytes, i) == kMarkerStart) ++i;
    const std::uint8_t marker = byte_at(bytes, i);
    if (!has_length(marker)) break;
    if (marker == kHuffmanTables && !huffman_tables_fit(bytes, i + 1)) return false;
    i += 1 + length_at(bytes, i + 1);
  }
  // From there on, a broken scan may end anywhere, and stb_image may read anything that looks like
  // tables as such
  for (; i + 1 < bytes.size(); ++i) {
    if (byte_at(bytes, i) != kMarkerStart || byte_at(bytes, i + 1) != kHuffmanTables) continue;
    if (!huffman_tables_fit(bytes, i + 2)) return false;
  }
  return true;
}

Expected<ImageHeader> read_stb_header(const std::string& path, ByteView bytes) {
  if (!is_safe_for_stb(bytes)) {
    return fail(path, "", "cannot be decoded: impossible Huffman tables");
  }
  Reader reader{bytes};
  ImageHeader header;
  if (stbi_info_from_callbacks(&kCallbacks, &reader, &header.width, &header.height,
                               &header.channels) == 0) {
    return fail(path, "", stb_cause(reader));
  }
  if (const auto ok = check_image_size(path, header.width, header.height, header.channels); !ok) {
    return tl::unexpected(ok.error());
  }
  return header;
}

Expected<StbPixels> decode_stb_bytes(const std::string& path, ByteView bytes, int channels) {
  Reader reader{bytes};
  int width = 0, height = 0, in_file = 0;
  StbPixels pixels(
      stbi_load_from_callbacks(&kCallbacks, &reader, &width, &height, &in_file, channels),
      &stbi_image_free);
  if (pixels == nullptr || reader.asked_beyond_end) return fail(path, "", stb_cause(reader));
  return pixels;
}

}  // namespace lambent
