// SPDX-License-Identifier: Apache-2.0
// Small glTF files made in memory, well formed or not.
#pragma once

#include <stb/stb_image_write.h>

#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "lambent/scene.h"
#include "scene/gltf/import.h"

namespace lambent::test {

using Json = nlohmann::json;

/// A PNG of RGBA pixels.
inline std::vector<std::uint8_t> png_of(int width, int height,
                                        const std::vector<std::uint8_t>& rgba) {
  std::vector<std::uint8_t> png;
  const auto append = [](void* context, void* data, int size) {
    auto& out = *static_cast<std::vector<std::uint8_t>*>(context);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), begin, begin + size);
  };
  stbi_write_png_to_func(append, &png, width, height, 4, rgba.data(), width * 4);
  return png;
}

class GltfBuilder {
 public:
  Json root = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::uint8_t> bytes;  ///< The GLB's binary chunk, buffers[0].

  /// Appends values to the buffer and a view of them; returns its index.
  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4 != 0) bytes.push_back(0);
    Json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride) view["byteStride"] = stride;
    const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes.insert(bytes.end(), begin, begin + values.size() * sizeof(T));
    return append("bufferViews", std::move(view));
  }

  /// An accessor of scalars or vectors given as plain numbers.
  template <class T>
  int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    Json accessor = {{"bufferView", view(values)},
                     {"componentType", component_type<T>()},
                     {"count", values.size() / components},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return append("accessors", std::move(accessor));
  }

  /// Appends to a list of the root and returns the index.
  int append(const char* list, Json value) {
    root[list].push_back(std::move(value));
    return static_cast<int>(root[list].size()) - 1;
  }

  /// A mesh of one primitive, a node that shows it, and a scene of all nodes.
  int show(Json primitive) {
    const int mesh = append("meshes", {{"primitives", Json::array({std::move(primitive)})}});
    show_node({{"mesh", mesh}});
    return mesh;
  }
  int show_node(Json node) {
    const int index = append("nodes", std::move(node));
    if (!root.contains("scenes")) append("scenes", {{"nodes", Json::array()}});
    root["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  /// One triangle in the plane z = 0, counter-clockwise seen from +z, as a primitive.
  Json triangle() {
    const int positions = accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    return {{"attributes", {{"POSITION", positions}}}};
  }

  std::vector<std::uint8_t> glb() const {
    Json complete = root;
    std::vector<std::uint8_t> binary = bytes;
    while (binary.size() % 4 != 0) binary.push_back(0);
    if (!binary.empty() && !complete.contains("buffers")) {
      complete["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
    }
    std::string text = complete.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::vector<std::uint8_t> file;
    const auto put = [&file](std::uint32_t value) {
      for (int i = 0; i < 4; ++i) file.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    };
    const std::size_t binary_chunk = binary.empty() ? 0 : 8 + binary.size();
    put(0x46546C67);
    put(2);
    put(static_cast<std::uint32_t>(20 + text.size() + binary_chunk));
    put(static_cast<std::uint32_t>(text.size()));
    put(0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    if (!binary.empty()) {
      put(static_cast<std::uint32_t>(binary.size()));
      put(0x004E4942);
      file.insert(file.end(), binary.begin(), binary.end());
    }
    return file;
  }

  Expected<Scene> load(const LoadOptions& options = {}) const {
    return load_scene_from_memory(glb(), options);
  }

 private:
  template <class T>
  static int component_type() {
    if (std::is_same_v<T, float>) return 5126;
    if (std::is_same_v<T, std::int8_t>) return 5120;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    return 5125;
  }
};

/// The error of something that must fail, as a user reads it; empty where it did not fail.
template <class T>
std::string error_of(const Expected<T>& result) {
  return result ? std::string() : result.error().message();
}

inline Expected<Scene> load_text(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(text.data());
  return load_scene_from_memory({begin, text.size()});
}

}  // namespace lambent::test
