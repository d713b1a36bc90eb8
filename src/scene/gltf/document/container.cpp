// SPDX-License-Identifier: Apache-2.0
// From the bytes of a .gltf or .glb to a checked Document: the GLB's chunks, the JSON, the buffers.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scene/gltf/channels.h"
#include "scene/gltf/document/document.h"
#include "scene/gltf/document/extensions.h"
#include "scene/gltf/document/meshopt.h"
#include "scene/gltf/document/schema.h"
#include "scene/gltf/fog.h"
#include "scene/gltf/volumes.h"
#include "scene/limits.h"

namespace lambent::gltf {
namespace {

using nlohmann::json;

// Deeper nesting than any exporter writes; the parsed model is walked recursively.
constexpr int kMaxJsonDepth = 64;
constexpr std::size_t kMaxJsonBytes = std::size_t{1} << 30;

// GLB layout, glTF 2.0 specification, sec. 4.4.
constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kGlbChunkHeaderBytes = 8;
constexpr std::uint32_t kGlbVersion = 2;
constexpr std::uint32_t kChunkJson = 0x4E4F534A;
constexpr std::uint32_t kChunkBinary = 0x004E4942;

// The GLB's parts; for a .gltf the whole file is JSON.
struct Chunks {
  ByteSpan json;
  ByteSpan binary;
  bool has_binary = false;
};

std::uint32_t read_u32(ByteSpan bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(bytes[offset]) |
         static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[offset + 2]) << 16 |
         static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

Expected<Chunks> split_chunks(ByteSpan bytes, const std::string& file) {
  Chunks chunks;
  if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) {
    chunks.json = bytes;
    return chunks;
  }
  if (bytes.size() < kGlbHeaderBytes) return fail(file, "header", "the file is truncated");
  if (read_u32(bytes, 4) != kGlbVersion) {
    return fail(file, "header",
                "GLB version " + std::to_string(read_u32(bytes, 4)) + " is not supported");
  }
  const std::size_t length = read_u32(bytes, 8);
  if (length > bytes.size()) {
    return fail(file, "header",
                "the file is truncated: it says it has " + std::to_string(length) +
                    " bytes, but has " + std::to_string(bytes.size()));
  }
  std::size_t offset = kGlbHeaderBytes;
  for (int i = 0; offset + kGlbChunkHeaderBytes <= length; ++i) {
    const std::size_t size = read_u32(bytes, offset);
    const std::uint32_t type = read_u32(bytes, offset + 4);
    offset += kGlbChunkHeaderBytes;
    if (size > length - offset) {
      return fail(file, entry("chunks", i), "the chunk extends beyond the end of the file");
    }
    if (i == 0 && type != kChunkJson) return fail(file, "chunks[0]", "the first chunk is not JSON");
    if (i == 0) chunks.json = bytes.subspan(offset, size);
    if (i == 1 && type == kChunkBinary) {
      chunks.binary = bytes.subspan(offset, size);
      chunks.has_binary = true;
    }
    offset += size;
  }
  if (chunks.json.empty()) return fail(file, "header", "the file has no JSON chunk");
  return chunks;
}

// Tested before parsing, so that no depth of nesting costs stack or memory.
bool nested_too_deeply(ByteSpan text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<char>(text[i]);
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kMaxJsonDepth) return true;
  }
  return false;
}

/// "line 2, column 13" of the byte of that number, from 1.
std::string line_and_column(ByteSpan text, std::size_t number) {
  const ByteSpan before = text.first(std::min(number > 0 ? number - 1 : 0, text.size()));
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const auto line_start = std::find(before.rbegin(), before.rend(), '\n');
  return "line " + std::to_string(lines + 1) + ", column " +
         std::to_string(line_start - before.rbegin() + 1);
}

Expected<json> parse_json(ByteSpan text, const std::string& file) {
  if (text.empty()) return fail(file, "", "the file is empty");
  if (text.size() > kMaxJsonBytes) return fail(file, "JSON", "the JSON is absurdly large");
  if (nested_too_deeply(text)) return fail(file, "JSON", "the JSON is nested too deeply");
  try {
    // Some exporters pad with zeros instead of spaces
    while (!text.empty() && text.back() == 0) text = text.first(text.size() - 1);
    return json::parse(text.begin(), text.end());
  } catch (const json::parse_error& error) {
    return fail(file, "JSON", "is not well-formed at " + line_and_column(text, error.byte));
  } catch (const json::out_of_range&) {
    return fail(file, "JSON", "holds a number that is too large to read");
  } catch (const json::exception& error) {
    return fail(file, "JSON", error.what());
  }
}

std::vector<std::string> strings_of(const json& root, const char* key) {
  std::vector<std::string> strings;
  if (!root.is_object() || !root.contains(key) || !root[key].is_array()) return strings;
  for (const json& value : root[key]) {
    if (value.is_string()) strings.push_back(value.get<std::string>());
  }
  return strings;
}

// The constant sky that Lambent's own writer stores in a scene's extras, since glTF has no property
// for it.
Expected<glm::vec3> read_sky(const json& sky) {
  if (!sky.is_array() || sky.size() != 3) return fail("", "", "is not a list of three numbers");
  glm::vec3 radiance(0.0f);
  for (int c = 0; c < 3; ++c) {
    if (!sky[c].is_number()) return fail("", "", "is not a list of three numbers");
    const double value = sky[c].get<double>();
    if (!(value >= 0.0 && value <= kMaxRadiance)) {
      return fail("", "", "is not within 0 to 1e10 W/(m^2 sr)");
    }
    radiance[c] = static_cast<float>(value);
  }
  return radiance;
}

// Extras may contain anything, so invalid ones cause a warning, not an error.
void read_skies(Document& document, const json& root) {
  const json scenes = root.value("scenes", json::array());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    document.scene_skies.emplace_back(0.0f);
    const json::json_pointer pointer("/extras/lambent_sky_radiance");
    if (!scenes[i].contains(pointer)) continue;
    const Expected<glm::vec3> sky = read_sky(scenes[i][pointer]);
    if (sky) {
      document.scene_skies.back() = *sky;
    } else {
      document.warn(entry("scenes", i) + ".extras.lambent_sky_radiance " + sky.error().cause +
                    "; the sky stays black.");
    }
  }
}

// Other "extras" have no meaning here and may contain anything.
void remove_extras(json& value) {
  if (value.is_object()) value.erase("extras");
  if (!value.is_structured()) return;
  for (json& member : value) remove_extras(member);
}

std::string string_or_empty(const json& object, const char* key) {
  const auto member = object.find(key);
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

bool is_fallback(const json& buffer) {
  const json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
  return buffer.contains(fallback) && buffer[fallback].get<bool>();
}

Expected<void> read_buffers(Document& document, const json& buffers, const Chunks& chunks) {
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const json& buffer = buffers[i];
    const std::string place = entry("buffers", i);
    const auto length = buffer["byteLength"].get<std::uint64_t>();
    Bytes bytes;
    if (buffer.contains("uri")) {
      LAMBENT_TRY(content, read_uri(document, buffer["uri"].get<std::string>(), place));
      bytes = std::move(content);
    } else if (i == 0 && chunks.has_binary) {
      bytes.assign(chunks.binary.begin(), chunks.binary.end());
    } else if (is_fallback(buffer)) {
      // A fallback buffer, which is empty: its views are compressed, and decompressed into memory
      // of their own
      document.buffers.emplace_back();
      continue;
    } else {
      return document.fail_at(place, "the buffer has neither a uri nor a binary chunk");
    }
    if (bytes.size() < length) {
      return document.fail_at(place, "the buffer is truncated: it should have " +
                                         std::to_string(length) + " bytes, but has " +
                                         std::to_string(bytes.size()));
    }
    document.buffers.push_back(std::move(bytes));
  }
  return {};
}

void read_image_sources(Document& document, const json& images) {
  for (const json& image : images) {
    ImageSource source;
    source.name = string_or_empty(image, "name");
    source.uri = string_or_empty(image, "uri");
    source.buffer_view = image.value("bufferView", -1);
    document.images.push_back(std::move(source));
  }
}

// Removes from the JSON what tinygltf would refuse or misread: index accessors without a buffer
// view (compressed primitives have none), buffers and images, which it would load without bounds,
// and animations, errors in which would make it refuse the whole file.
void take_out(Document& document, json& root) {
  for (json& mesh : root.value("meshes", json::array())) {
    std::vector<int>& indices = document.primitive_indices.emplace_back();
    for (const json& primitive : mesh["primitives"])
      indices.push_back(primitive.value("indices", -1));
  }
  if (root.contains("meshes")) {
    for (json& mesh : root["meshes"]) {
      for (json& primitive : mesh["primitives"]) primitive.erase("indices");
    }
  }
  if (root.contains("images")) read_image_sources(document, root["images"]);
  root.erase("images");
  root.erase("animations");
  root.erase("buffers");
}

Expected<void> parse_model(Document& document, const json& root) {
  const std::string text = root.dump();
  tinygltf::TinyGLTF loader;
  std::string error;
  std::string warning;
  const bool loaded = loader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                                 static_cast<unsigned int>(text.size()), "");
  // Errors that it reports without failing are missing optional properties that it considers
  // required
  if (!loaded) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    return document.fail_at("JSON", error);
  }
  return {};
}

// tinygltf skips objects that it cannot parse, which would shift indices that were checked before.
bool same_sizes(const Document& document, const json& root) {
  const auto size_of = [&root](const char* key) {
    return root.contains(key) ? root[key].size() : std::size_t{0};
  };
  const tinygltf::Model& model = document.model;
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    if (i >= document.primitive_indices.size()) return false;
    if (model.meshes[i].primitives.size() != document.primitive_indices[i].size()) return false;
  }
  return model.accessors.size() == size_of("accessors") &&
         model.bufferViews.size() == size_of("bufferViews") &&
         model.meshes.size() == size_of("meshes") && model.nodes.size() == size_of("nodes") &&
         model.materials.size() == size_of("materials") &&
         model.textures.size() == size_of("textures") &&
         model.samplers.size() == size_of("samplers") && model.skins.size() == size_of("skins") &&
         model.cameras.size() == size_of("cameras") && model.scenes.size() == size_of("scenes");
}

// Specification, sec. 3.2: files of later minor versions load, unless they ask for one.
Expected<void> check_version(const Document& document, const json& asset) {
  const std::string version = string_or_empty(asset, "version");
  if (!version.starts_with("2.")) {
    return document.fail_at("asset.version", "glTF version " + version + " is not supported");
  }
  const std::string least = string_or_empty(asset, "minVersion");
  if (!least.empty() && least != "2.0") {
    return document.fail_at("asset.minVersion", "glTF version " + least + " is not supported");
  }
  return {};
}

}  // namespace

Expected<Document> read_document(ByteSpan bytes, const std::string& file, bool file_access) {
  Document document;
  document.file = file;
  document.folder = std::filesystem::path(file).parent_path().string();
  document.file_access = file_access;

  LAMBENT_TRY(chunks, split_chunks(bytes, file));
  LAMBENT_TRY(root, parse_json(chunks.json, file));
  // An unknown required extension may change everything else, so check these first
  document.model.extensionsUsed = strings_of(root, "extensionsUsed");
  document.model.extensionsRequired = strings_of(root, "extensionsRequired");
  LAMBENT_CHECK(check_extensions(document));
  LAMBENT_TRY(repaired, check_schema(root, file));
  for (const std::string& place : repaired) {
    document.repaired("numbers out of the range of glTF were brought into it or left out", 1,
                      place);
  }
  LAMBENT_CHECK(check_version(document, root["asset"]));

  if (root.contains("buffers")) LAMBENT_CHECK(read_buffers(document, root["buffers"], chunks));
  read_skies(document, root);
  read_node_flags(document, root);
  read_node_volumes(document, root);
  read_node_fog(document, root);
  read_channels(document, root);
  remove_extras(root);
  take_out(document, root);
  LAMBENT_CHECK(parse_model(document, root));
  if (!same_sizes(document, root)) return document.fail_at("JSON", "the structure is malformed");
  LAMBENT_CHECK(decompress_views(document));
  return document;
}

void Document::warn(std::string sentence) {
  // Names come from files: remove control characters, which must not reach a terminal
  constexpr unsigned char kFirstPrintable = 0x20, kDelete = 0x7f;
  for (char& c : sentence) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < kFirstPrintable || byte == kDelete) c = '?';
  }
  warnings.push_back(std::move(sentence));
}

void Document::repaired(const std::string& what, std::size_t count, const std::string& place) {
  if (count == 0) return;
  for (Repair& repair : repairs) {
    if (repair.what != what) continue;
    repair.count += count;
    return;
  }
  repairs.push_back({what, count, place});
}

void Document::warn_of_repairs() {
  for (const Repair& repair : repairs) {
    warn(std::to_string(repair.count) + " " + repair.what + ", first in " + repair.first + ".");
  }
  repairs.clear();
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

double number_or(const tinygltf::Value& object, const char* key, double fallback) {
  return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

int integer_or(const tinygltf::Value& object, const char* key, int fallback) {
  return object.Has(key) ? object.Get(key).GetNumberAsInt() : fallback;
}

}  // namespace lambent::gltf
