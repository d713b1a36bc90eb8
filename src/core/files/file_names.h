// SPDX-License-Identifier: Apache-2.0
// The file to which a path refers, and whether two paths refer to the same one.
#pragma once

#include <span>
#include <string>

#include "lambent/error.h"

namespace lambent {

/// The target of a path after its symbolic links are followed.
struct PathEnd {
  std::string path;  ///< Need not exist; its directories have no links where they exist.
  /// For an open file of this process (/dev/stdout), its descriptor; else -1.
  int descriptor = -1;
};
/// Follows links to their end, also to a file that does not exist yet, as open(2) with O_CREAT
/// does.
PathEnd end_of_path(const std::string& path);

/// Whether both paths refer to one file: by another spelling, through symbolic links, as hard links
/// of each other, or, before either exists, by names that the file system treats as the same (such
/// as "A.png" and "a.png" where case does not count). Devices and pipes never count as the same
/// file: writing twice to /dev/null loses nothing.
bool same_file(const std::string& a, const std::string& b);

/// A file that a command reads or writes.
struct NamedFile {
  std::string path;
  std::string role;  ///< Its description for the user, such as "--stats" or "the scene".
  bool written = false;
};

/// Fails where a file that is written is also read, or written twice, naming both. Empty paths are
/// ignored.
Expected<void> check_distinct_files(std::span<const NamedFile> files);

}  // namespace lambent
