// SPDX-License-Identifier: Apache-2.0
#include "lambent/output.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "core/files/atomic_file.h"
#include "lambent/parse.h"
#include "lambent/words.h"
#include "scenes/builtin.h"

namespace lambent::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEndingsOfOtherFiles[] = {".png", ".jpg",  ".jpeg", ".exr",
                                                ".hdr", ".gltf", ".glb",  ".json"};

tl::unexpected<Error> cannot_make(const std::string& path, const fs::path& folder,
                                  const std::string& cause) {
  return fail(path, "", "cannot make the folder " + folder.string() + ": " + cause,
              Error::Kind::failed);
}

}  // namespace

Expected<void> check_place(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  if (path.empty() || folder.empty() || fs::is_directory(folder, error)) {
    return check_writable(path);
  }
  // The deepest existing folder must permit creating the next one
  fs::path there = folder;
  while (!there.empty() && !fs::exists(there, error)) there = there.parent_path();
  if (there.empty()) there = ".";
  if (!fs::is_directory(there, error)) {
    return cannot_make(path, folder, there.string() + " is not a folder");
  }
  if (::access(there.c_str(), W_OK | X_OK) == 0) return {};
  return cannot_make(path, folder, std::generic_category().message(errno));
}

Expected<void> check_output(const std::string& path, std::initializer_list<const char*> endings) {
  for (const char* ending : endings) {
    if (has_ending(path, ending)) return check_place(path);
  }
  const std::vector<std::string> names(endings.begin(), endings.end());
  return fail(path, "", "the output must end in " + list_text(names));
}

Expected<void> check_layers(bool layers, const std::string& output) {
  if (!layers || has_ending(output, ".exr")) return {};
  return fail("--layers", "", "go into an .exr alone: add -o FILE.exr");
}

Expected<void> check_own_output(const std::string& path, const std::string& what) {
  for (const char* ending : kEndingsOfOtherFiles) {
    if (has_ending(path, ending)) {
      return fail(path, "",
                  "the output is " + what + ", whose name may not end in " + std::string(ending));
    }
  }
  return check_place(path);
}

Expected<void> make_folders(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) return {};
  std::error_code error;
  fs::create_directories(folder, error);
  // create_directories may report an error for "new/." and links to folders, which exist
  // nevertheless
  std::error_code ignored;
  if (!error || fs::is_directory(folder, ignored)) return {};
  return cannot_make(path, folder, error.message());
}

Expected<void> write_statistics(const std::string& path, const nlohmann::ordered_json& statistics) {
  if (const auto fine = make_folders(path); !fine) return fine;
  return write_file_atomically(path, statistics.dump(2) + "\n");
}

std::string picture_beside(const std::string& scene) {
  if (scenes::is_name(scene)) return scene + ".png";
  return fs::path(scene).replace_extension(".png").string();
}

}  // namespace lambent::cli
