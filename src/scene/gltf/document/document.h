// SPDX-License-Identifier: Apache-2.0
// A glTF file after its container has been read and its structure checked, before its meaning is
// taken.
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

/// Where the encoded bytes of an image stand.
struct ImageSource {
  std::string name;
  std::string uri;       ///< As written in the file; empty: `buffer_view` counts.
  int buffer_view = -1;  ///< Index into Document::model.bufferViews.
};

/// Something repaired or left out, many times perhaps, that deserves one warning.
struct Repair {
  std::string what;  ///< "triangles without area were dropped".
  std::size_t count = 0;
  std::string first;  ///< Where it happened first.
};

/// One channel of an animation, as the file has it.
struct ChannelSource {
  std::string place;          ///< "animations[0].channels[2]".
  std::string pointer;        ///< What it drives, as a JSON pointer: "/nodes/3/translation".
  int input = 0, output = 0;  ///< Accessors of its times and values.
  Interpolation interpolation = Interpolation::linear;
};
struct AnimationSource {
  std::string name;
  std::vector<ChannelSource> channels;
};

/// What the extras of a node say of the instances in it.
struct NodeFlags {
  bool casts_gi = true, receives_gi = true, ignored_by_probes = false;
};

/// A checked glTF file. Every index in `model` is in range or -1, every array has the length that
/// the specification asks for, every number is finite and within its range.
struct Document {
  std::string file;         ///< For errors; empty where the file came from memory.
  std::string folder;       ///< That relative URIs start from.
  bool file_access = true;  ///< false: URIs other than data URIs are errors.
  tinygltf::Model model;    ///< Without buffers, images, animations, extras.
  std::vector<Bytes> buffers;
  std::vector<glm::vec3> scene_skies;  ///< Constant sky radiance of each scene; black: none.
  std::vector<ImageSource> images;
  std::vector<AnimationSource> animations;  ///< Without channels that make no sense.
  std::vector<NodeFlags> node_flags;        ///< One a node.
  std::map<int, ProbeVolume> node_volumes;  ///< Of nodes that ask for one; not placed yet.
  std::map<int, FogVolume> node_fog;        ///< Likewise.
  std::vector<std::vector<int>>
      primitive_indices;                  ///< Accessor of each mesh's primitives' indices; or -1.
  std::vector<Bytes> decompressed_views;  ///< Of views with EXT_meshopt_compression; else empty.
  std::vector<std::string> warnings;
  std::vector<Repair> repairs;

  tl::unexpected<Error> fail_at(std::string place, std::string cause) const {
    return fail(file, std::move(place), std::move(cause));
  }
  void warn(std::string sentence);
  /// Counts `count` repairs of one kind; warn_of_repairs makes one warning of each kind.
  void repaired(const std::string& what, std::size_t count, const std::string& place);
  void warn_of_repairs();
  /// Counts a channel that is left out, and tells why.
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

/// What a URI stands for: the bytes of a data URI, or of a file relative to the document's folder.
Expected<Bytes> read_uri(const Document& document, const std::string& uri,
                         const std::string& place);

/// The file that a relative URI means; empty where it means none, as a data URI does.
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

/// The same for an Expected<void>.
#define LAMBENT_CHECK(expression)                      \
  if (auto checked = (expression); !checked) {         \
    return tl::unexpected(std::move(checked).error()); \
  }
