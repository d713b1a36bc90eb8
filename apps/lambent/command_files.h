// SPDX-License-Identifier: Apache-2.0
// All files that a subcommand reads and writes, so that none is lost to another.
#pragma once

#include <string>
#include <vector>

#include "core/files/file_names.h"
#include "lambent/error.h"

namespace lambent::cli {

/// Told of each file before any work is done. Empty paths count for nothing.
class CommandFiles {
 public:
  /// `role` is what the user knows the file by: "--field", "the scene".
  void reads(const std::string& path, const std::string& role);
  /// A scene's file with all that it refers to; nothing where it is a built-in one.
  void reads_scene(const std::string& scene);
  void writes(const std::string& path, const std::string& role);
  /// Pictures 0 to count - 1 of a sequence, named as frame_path does.
  void writes_frames(const std::string& pattern, int count, const std::string& role);

  /// Fails where a file would be written over another one of the command's, whatever the paths are
  /// called (see same_file).
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
