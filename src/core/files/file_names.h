// SPDX-License-Identifier: Apache-2.0
// Which file a path means, and whether two paths mean the same one.
#pragma once

#include <span>
#include <string>

#include "lambent/error.h"

namespace lambent {

/// Where a path leads once its symbolic links are followed.
struct PathEnd {
  std::string path;     ///< Need not exist; its directories have no links where they exist.
  int descriptor = -1;  ///< Where it is an open file of this process (/dev/stdout): which; or -1.
};
/// Follows links to their end, also to a file that does not exist yet, as open(2) with O_CREAT
/// does.
PathEnd end_of_path(const std::string& path);

/// Whether both paths mean one file: by another spelling, through symbolic links, as hard links of
/// each other, or, before either exists, by names that the file system takes for the same (such as
/// "A.png" and "a.png" where case does not count). Devices and pipes are never the same file: that
/// two things go to /dev/null loses nothing.
bool same_file(const std::string& a, const std::string& b);

/// A file that a command was told to read or to write.
struct NamedFile {
  std::string path;
  std::string role;  ///< What the user knows it by, such as "--stats" or "the scene".
  bool written = false;
};

/// Fails where a file that is written is also read, or written twice, naming both. Empty paths
/// count for nothing.
Expected<void> check_distinct_files(std::span<const NamedFile> files);

}  // namespace lambent
