// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scene/gltf/document/document.h"

namespace lambent {
namespace {

using nlohmann::json;

// A GLB begins with its magic, version and length, and the length and type of its JSON chunk (glTF
// 2.0 specification, sec. 4.4).
constexpr std::size_t kGlbOpening = 20;
constexpr std::size_t kJsonLengthAt = 12;
// Largest JSON; load_scene refuses larger ones.
constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{1} << 30;

/// The JSON of a .gltf or .glb, truncated if the file is.
std::string json_text(const std::string& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  std::array<char, kGlbOpening> opening{};
  if (error || !file.read(opening.data(), opening.size())) return {};
  std::uintmax_t length = bytes;
  if (std::equal(opening.begin(), opening.begin() + 4, "glTF")) {
    length = 0;
    for (std::size_t i = 4; i-- > 0;) {
      length = length << 8 | static_cast<unsigned char>(opening[kJsonLengthAt + i]);
    }
  } else {
    file.seekg(0);
  }
  if (length > bytes || length > kMaxJsonBytes) return {};
  std::string text(length, '\0');
  file.read(text.data(), static_cast<std::streamsize>(length));
  return text;
}

}  // namespace

std::vector<std::string> files_of_gltf(const std::string& path) {
  std::vector<std::string> files;
  const json root = json::parse(json_text(path), nullptr, /*allow_exceptions=*/false);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  for (const char* array : {"buffers", "images"}) {
    if (!root.is_object() || !root.contains(array) || !root[array].is_array()) continue;
    for (const json& entry : root[array]) {
      if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
      const std::string file = gltf::path_of_uri(folder, entry["uri"].get<std::string>());
      if (!file.empty()) files.push_back(file);
    }
  }
  return files;
}

}  // namespace lambent
