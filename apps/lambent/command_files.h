// SPDX-License-Identifier: Apache-2.0
// All files that a subcommand reads and writes, to prevent that one overwrites another.
#pragma once

#include <string>
#include <vector>

#include "core/files/file_names.h"
#include "lambent/error.h"

namespace lambent::cli {

/// Collects the files before any work is done. Empty paths are ignored.
class CommandFiles {
 public:
  /// `role` describes the file to the user: "--field", "the scene".
  void reads(const std::string& path, const std::string& role);
  /// Adds a scene's file with all files to which it refers; none for a built-in scene.
  void reads_scene(const std::string& scene);
  void writes(const std::string& path, const std::string& role);
  /// Adds pictures 0 to count - 1 of a sequence, named by frame_path.
  void writes_frames(const std::string& pattern, int count, const std::string& role);

  /// Fails where a file would overwrite another one of the command, however the paths are spelled
  /// (see same_file).
  Expected<void> check() const;

 private:
  struct Frames {
    std::string pattern;
    int count = 0;
    std::string role;
  };
  std::vector<NamedFile> files_;
  std::vector<Frames> frames_;
};

}  // namespace lambent::cli
