// SPDX-License-Identifier: Apache-2.0
#include "core/image_stb.h"

#include <algorithm>
#include <cstring>

#include "core/stb.h"

namespace lambent {
namespace {

/// stb_image goes on with zeros where a file ends; the reader remembers that it was asked for more.
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

}  // namespace

Expected<ImageHeader> read_stb_header(const std::string& path, ByteView bytes) {
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
