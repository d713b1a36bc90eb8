// SPDX-License-Identifier: Apache-2.0
#include "lambent/input.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/nearest_word.h"
#include "lambent/parse.h"
#include "lambent/words.h"
#include "scenes/builtin.h"

namespace lambent::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

enum class Content { unknown, scene, image, field, prepared, foreign };

struct Kind {
  Content content = Content::unknown;
  std::string name;    // "an OpenEXR image"
  std::string advice;  // What makes a scene of it; may be empty.
};

/// The first bytes of files of a kind.
struct Signature {
  std::string_view bytes;
  Content content;
  const char* name;
  const char* advice = "";
};
constexpr const char* kConvert = "convert it to glTF, say with Blender";
constexpr const char* kUnpack = "unpack it first";
constexpr Signature kSignatures[] = {
    {"glTF"sv, Content::scene, "a binary glTF scene"},
    {"\x76\x2f\x31\x01"sv, Content::image, "an OpenEXR image"},
    {"#?RADIANCE"sv, Content::image, "a Radiance image"},
    {"#?RGBE"sv, Content::image, "a Radiance image"},
    {"\x89PNG\r\n\x1a\n"sv, Content::image, "a PNG image"},
    {"\xff\xd8\xff"sv, Content::image, "a JPEG image"},
    {"LAMBENTF"sv, Content::field, "a field of lambent bake"},
    {"lambent prepared"sv, Content::prepared, "a prepared scene, which lambent_gpu_bench reads"},
    {"\xabKTX 20\xbb"sv, Content::foreign, "a KTX2 texture"},
    {"Kaydara FBX"sv, Content::foreign, "an FBX scene", kConvert},
    {"BLENDER"sv, Content::foreign, "a Blender file", "export it as glTF"},
    {"PXR-USDC"sv, Content::foreign, "a USD scene", kConvert},
    {"#usda"sv, Content::foreign, "a USD scene", kConvert},
    {"ply\n"sv, Content::foreign, "a PLY mesh", kConvert},
    {"ply\r\n"sv, Content::foreign, "a PLY mesh", kConvert},
    {"PK\x03\x04"sv, Content::foreign, "a ZIP archive", kUnpack},
    {"\x1f\x8b"sv, Content::foreign, "a gzip archive", kUnpack},
};
// Bytes of a file that are examined: more than any signature, and than white space before JSON.
constexpr std::size_t kLookedAt = 512;

/// Text files without a signature, which are recognised by their ending.
struct ForeignEnding {
  const char* ending;
  const char* name;
  const char* advice;
};
constexpr ForeignEnding kForeignEndings[] = {
    {".obj", "a Wavefront OBJ scene", kConvert},
    {".dae", "a COLLADA scene", kConvert},
    {".stl", "an STL mesh", kConvert},
    {".3ds", "a 3D Studio scene", kConvert},
};

/// The kind of a file, by its first bytes, or by its ending.
Kind kind_of(const std::string& path) {
  std::array<char, kLookedAt> bytes{};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), bytes.size());
  const std::string_view start(bytes.data(), static_cast<std::size_t>(file.gcount()));
  for (const Signature& signature : kSignatures) {
    if (start.starts_with(signature.bytes))
      return {signature.content, signature.name, signature.advice};
  }
  for (const ForeignEnding& foreign : kForeignEndings) {
    if (has_ending(path, foreign.ending)) return {Content::foreign, foreign.name, foreign.advice};
  }
  // JSON, with a byte order mark or without
  std::string_view text = start;
  if (text.starts_with("\xef\xbb\xbf"sv)) text.remove_prefix(3);
  const auto* first =
      std::find_if(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) == 0; });
  const bool blank_so_far = first == text.end() && start.size() == kLookedAt;
  if (blank_so_far || (first != text.end() && *first == '{')) {
    return {Content::scene, "JSON text, as glTF scenes are", ""};
  }
  return {Content::unknown, text.empty() ? "an empty file" : "", ""};
}

/// The subcommands that read files of that content; empty: none.
std::string readers_of(Content content) {
  switch (content) {
    case Content::scene:
      return "; lambent render and lambent info read scenes";
    case Content::image:
      return "; lambent picture and lambent compare read images";
    case Content::field:
      return "; lambent field and lambent render --field read fields";
    case Content::prepared:
    case Content::foreign:
    case Content::unknown:
      return "";
  }
  return "";
}

/// The names of the files of a folder, in order.
std::vector<std::string> files_of(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

tl::unexpected<Error> missing(const std::string& path, bool scene) {
  const fs::path folder = fs::path(path).parent_path(), name = fs::path(path).filename();
  std::error_code error;
  if (!folder.empty() && !fs::exists(folder, error)) {
    return fail(path, "", "no such file: there is no folder " + folder.string());
  }
  std::vector<std::string> known = files_of(folder);
  const bool word = scene && folder.empty();
  if (word) {
    const std::vector<std::string> builtin = scenes::names();
    known.insert(known.begin(), builtin.begin(), builtin.end());
  }
  const std::string nearest = did_you_mean(name.string(), known);
  const std::string cause = word ? "no such file, nor a built-in scene" : "no such file";
  if (!nearest.empty() || !word) return fail(path, "", cause + nearest);
  return fail(path, "", cause + " (lambent scenes lists these)");
}

/// The error "is a folder", with the scenes in it.
tl::unexpected<Error> is_folder(const std::string& path, bool scene) {
  std::vector<std::string> names;
  for (const std::string& name : files_of(path)) {
    if (has_ending(name, ".gltf") || has_ending(name, ".glb")) names.push_back(name);
  }
  constexpr std::size_t kMostNames = 8;
  if (!scene || names.empty() || names.size() > kMostNames) {
    return fail(path, "", "is a folder, not a file");
  }
  return fail(path, "", "is a folder, not a file; it has " + list_text(names, "and"));
}

/// Fails unless there is a file at `path` that is, or might be, of the wanted content.
Expected<void> check_input(const std::string& path, Content wanted, const char* wanted_name) {
  const bool scene = wanted == Content::scene;
  std::error_code error;
  if (!fs::exists(path, error)) return missing(path, scene);
  if (fs::is_directory(path, error)) return is_folder(path, scene);
  // Reading from a pipe would consume its content
  if (!fs::is_regular_file(path, error)) return {};
  const Kind kind = kind_of(path);
  if (kind.content == wanted || (kind.content == Content::unknown && !scene)) return {};
  const std::string what = kind.name.empty() ? "" : kind.name + ", ";
  const std::string advice = scene && !kind.advice.empty() ? ": " + kind.advice : "";
  return fail(path, "", "is " + what + "not " + wanted_name + advice + readers_of(kind.content));
}

}  // namespace

Expected<void> check_image_input(const std::string& path) {
  return check_input(path, Content::image, "an image");
}

Expected<void> check_field_input(const std::string& path) {
  return check_input(path, Content::field, "a field");
}

Expected<void> check_scene_input(const std::string& path_or_name) {
  if (scenes::is_name(path_or_name)) return {};
  return check_input(path_or_name, Content::scene, "a glTF scene");
}

Expected<Scene> open_scene_input(const std::string& path_or_name, const LoadOptions& options) {
  const auto fine = check_scene_input(path_or_name);
  if (!fine) return tl::unexpected(fine.error());
  return scenes::open_scene(path_or_name, options);
}

}  // namespace lambent::cli
