// SPDX-License-Identifier: Apache-2.0
// Reads the bytes of URIs and buffer views.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "core/files/file_bytes.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {
namespace {

constexpr std::uint8_t kNotBase64 = 255;

constexpr std::array<std::uint8_t, 256> make_base64_values() {
  std::array<std::uint8_t, 256> values{};
  for (auto& value : values) value = kNotBase64;
  for (int i = 0; i < 26; ++i) {
    values['A' + i] = static_cast<std::uint8_t>(i);
    values['a' + i] = static_cast<std::uint8_t>(26 + i);
  }
  for (int i = 0; i < 10; ++i) values['0' + i] = static_cast<std::uint8_t>(52 + i);
  values['+'] = values['-'] = 62;
  values['/'] = values['_'] = 63;
  return values;
}

// RFC 4648. False where the text holds anything but base64.
bool decode_base64(std::string_view text, Bytes& bytes) {
  static constexpr auto kValues = make_base64_values();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::uint8_t value = kValues[static_cast<unsigned char>(c)];
    if (value == kNotBase64) return false;
    bits = bits << 6 | value;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
  }
  return true;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// RFC 3986, sec. 2.1. Invalid escapes remain unchanged, since not every exporter escapes.
std::string decode_percent(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = i + 2 < text.size() && text[i] == '%' ? hex_value(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_value(text[i + 2]) : -1;
    if (low >= 0) {
      decoded += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// RFC 3986, sec. 3.1: a letter, then letters, digits, "+", "-" or ".", then a colon.
bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  for (const char c : uri.substr(0, colon)) {
    const bool allowed = is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
    if (!allowed) return false;
  }
  return true;
}

// Whether a decoded path begins with a drive of Windows, as "C:/a.bin" does: no scheme in use has
// one letter.
bool starts_with_drive(std::string_view path) {
  return path.size() >= 3 && is_letter(path[0]) && path[1] == ':' &&
         (path[2] == '\\' || path[2] == '/');
}

// The file of a decoded path. Exporters on Windows write "textures\\wood.png": where there is no
// such file, backslashes part folders.
std::string file_of(const std::string& folder, std::string path) {
  const std::string as_written = (std::filesystem::path(folder) / path).string();
  std::error_code error;
  if (path.find('\\') == std::string::npos || std::filesystem::exists(as_written, error)) {
    return as_written;
  }
  std::replace(path.begin(), path.end(), '\\', '/');
  return (std::filesystem::path(folder) / path).string();
}

}  // namespace

std::string path_of_uri(const std::string& folder, const std::string& uri) {
  if (has_scheme(uri) || uri.starts_with("//")) return {};
  const std::string path = decode_percent(uri);
  if (path.empty() || path.find('\0') != std::string::npos) return {};
  return file_of(folder, path);
}

Expected<Bytes> read_uri(const Document& document, const std::string& uri,
                         const std::string& place) {
  if (uri.rfind("data:", 0) == 0) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || uri.rfind(";base64", comma) == std::string::npos) {
      return document.fail_at(place, "the data URI is not base64");
    }
    Bytes bytes;
    if (!decode_base64(std::string_view(uri).substr(comma + 1), bytes)) {
      return document.fail_at(place, "the data URI holds characters that are not base64");
    }
    return bytes;
  }
  const std::string path = decode_percent(uri);
  if (path.empty() || path.find('\0') != std::string::npos) {
    return document.fail_at(place, "the URI is malformed");
  }
  constexpr std::size_t kShown = 80;
  const std::string shown = uri.substr(0, kShown);
  if (starts_with_drive(path)) {
    return document.fail_at(place, "the URI " + shown +
                                       " is an absolute path on another machine: put the file "
                                       "beside the scene's, and give its name alone as the URI");
  }
  if (has_scheme(uri) || uri.rfind("//", 0) == 0) {
    return document.fail_at(place, "the URI " + shown + " is not a file: nothing is downloaded");
  }
  if (path[0] == '/' || path[0] == '\\') {
    return document.fail_at(place, "the URI " + shown + " is absolute, which glTF does not allow");
  }
  if (!document.file_access) {
    return document.fail_at(place,
                            "the URI " + shown + " refers to a file, but this scene has none");
  }
  const std::string full = file_of(document.folder, path);
  const Expected<std::vector<std::byte>> content = read_file(full);
  if (!content) return document.fail_at(place + " (" + full + ")", content.error().cause);
  const auto* begin = reinterpret_cast<const std::uint8_t*>(content->data());
  return Bytes(begin, begin + content->size());
}

Expected<ByteSpan> view_bytes(const Document& document, int view) {
  if (!document.decompressed_views[view].empty()) {
    return ByteSpan(document.decompressed_views[view]);
  }
  const tinygltf::BufferView& source = document.model.bufferViews[view];
  const Bytes& buffer = document.buffers[source.buffer];
  if (source.byteOffset > buffer.size() || source.byteLength > buffer.size() - source.byteOffset) {
    return document.fail_at(entry("bufferViews", view),
                            "extends beyond the end of " + entry("buffers", source.buffer));
  }
  return ByteSpan(buffer).subspan(source.byteOffset, source.byteLength);
}

}  // namespace lambent::gltf
