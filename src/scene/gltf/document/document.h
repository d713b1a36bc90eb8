// SPDX-License-Identifier: Apache-2.0
// A glTF file whose container was read and whose structure was checked, before it is converted to a
// scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lambent/animation.h"
#include "lambent/error.h"
#include "lambent/scene.h"
#include "scene/gltf/document/tinygltf.h"

namespace lambent::gltf {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

/// The location of an image's encoded bytes.
struct ImageSource {
  std::string name;
  std::string uri;       ///< As written in the file; empty: use `buffer_view`.
  int buffer_view = -1;  ///< Index into Document::model.bufferViews.
};

/// A kind of repair or omission, which may occur many times, for one warning.
struct Repair {
  std::string what;  ///< "triangles without area were dropped".
  std::size_t count = 0;
  std::string first;  ///< Place of the first occurrence.
};

/// One channel of an animation in the file.
struct ChannelSource {
  std::string place;          ///< "animations[0].channels[2]".
  std::string pointer;        ///< The driven property, as a JSON pointer: "/nodes/3/translation".
  int input = 0, output = 0;  ///< Accessors of its times and values.
  Interpolation interpolation = Interpolation::linear;
};
struct AnimationSource {
  std::string name;
  std::vector<ChannelSource> channels;
};

/// Flags in the extras of a node, for its instances.
struct NodeFlags {
  bool casts_gi = true, receives_gi = true, ignored_by_probes = false;
};

/// A checked glTF file. Every index in `model` is in range or -1, every array has the length that
/// the specification requires, every number is finite and within its range.
struct Document {
  std::string file;         ///< For errors; empty where the file came from memory.
  std::string folder;       ///< Base of relative URIs.
  bool file_access = true;  ///< false: URIs other than data URIs are errors.
  tinygltf::Model model;    ///< Without buffers, images, animations, extras.
  std::vector<Bytes> buffers;
  std::vector<glm::vec3> scene_skies;  ///< Constant sky radiance of each scene; black: none.
  std::vector<ImageSource> images;
  std::vector<AnimationSource> animations;  ///< Without invalid channels.
  std::vector<NodeFlags> node_flags;        ///< One per node.
  std::map<int, ProbeVolume> node_volumes;  ///< Probe volumes by node; not placed yet.
  std::map<int, FogVolume> node_fog;        ///< Fog by node; not placed yet.
  std::vector<std::vector<int>>
      primitive_indices;                  ///< Accessor of each mesh's primitives' indices; or -1.
  std::vector<Bytes> decompressed_views;  ///< For views with EXT_meshopt_compression; else empty.
  std::vector<std::string> warnings;
  std::vector<Repair> repairs;

  tl::unexpected<Error> fail_at(std::string place, std::string cause) const {
    return fail(file, std::move(place), std::move(cause));
  }
  void warn(std::string sentence);
  /// Counts `count` repairs of one kind; warn_of_repairs makes one warning of each kind.
  void repaired(const std::string& what, std::size_t count, const std::string& place);
  void warn_of_repairs();
  /// Counts a dropped channel, with the reason.
  void drop_channel(const std::string& place, const std::string& why) {
    repaired("animation channels were dropped because " + why, 1, place);
  }
};

/// "meshes[3]": the name of an entry in errors and warnings.
inline std::string entry(const char* array, std::size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

/// Three numbers of the file; `fallback` where it has none.
inline glm::vec3 vec3_of(const std::vector<double>& numbers, const glm::vec3& fallback) {
  return numbers.size() == 3 ? glm::vec3(numbers[0], numbers[1], numbers[2]) : fallback;
}

/// Reads container, JSON and buffers. `bytes` is the whole .gltf or .glb.
Expected<Document> read_document(ByteSpan bytes, const std::string& file, bool file_access);

/// The bytes of a buffer view (decompressed where it was compressed); they live as long as the
/// document.
Expected<ByteSpan> view_bytes(const Document& document, int view);

/// The bytes of a data URI, or of a file relative to the document's folder.
Expected<Bytes> read_uri(const Document& document, const std::string& uri,
                         const std::string& place);

/// The path of the file to which a relative URI refers; empty for others, such as data URIs.
std::string path_of_uri(const std::string& folder, const std::string& uri);

/// The extension `name` among `extensions`, or null.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name);

/// A member of a JSON object as a number, or `fallback` where it is missing.
double number_or(const tinygltf::Value& object, const char* key, double fallback);
int integer_or(const tinygltf::Value& object, const char* key, int fallback);

}  // namespace lambent::gltf

/// Evaluates an Expected; names its value `name`, or leaves the function with its error.
#define LAMBENT_TRY(name, expression)                                              \
  auto name##_or_error = (expression);                                             \
  if (!name##_or_error) return tl::unexpected(std::move(name##_or_error).error()); \
  auto& name = *name##_or_error

/// Evaluates an Expected<void>, and leaves the function with its error.
#define LAMBENT_CHECK(expression)                      \
  if (auto checked = (expression); !checked) {         \
    return tl::unexpected(std::move(checked).error()); \
  }
