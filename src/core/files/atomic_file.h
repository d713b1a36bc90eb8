// SPDX-License-Identifier: Apache-2.0
// Files that come to be whole or not at all.
//
// A file is written without a name where the system can (O_TMPFILE) and is given its name when it
// is complete: whatever ends the program before, be it a signal, a crash or a loss of power, leaves
// nothing behind, with no handler and no cleaning up. Elsewhere (NFS, FAT) it has a temporary name
// beside the target, which discard_unfinished_files removes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "lambent/error.h"

namespace lambent {

/// A file under construction. Without commit() it never comes to be, and what was there stays.
class AtomicFile {
 public:
  /// How the file is kept until it is complete: without a name where the system can, or with one.
  enum class Unfinished { nameless_if_possible, named };

  /// Begins the file. A symbolic link keeps pointing where it did, also where that does not exist
  /// yet. Devices, pipes and open descriptors (/dev/null, /dev/stdout) cannot be replaced: they are
  /// sent the whole content on commit. Fails with bad_input on an empty name and on a directory,
  /// else with failed.
  static Expected<AtomicFile> open(const std::string& path,
                                   Unfinished how = Unfinished::nameless_if_possible);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) = delete;
  ~AtomicFile();

  /// Appends at the current position. After a failure only destruction makes sense.
  Expected<void> write(std::span<const std::byte> bytes);
  /// Goes to a position [bytes from the start] to write over what is there.
  Expected<void> seek(std::uint64_t position);
  /// The name that the user gave.
  const std::string& path() const { return path_; }

  /// Makes the file what was written. Fails where the disk is full, too; nothing remains then.
  Expected<void> commit();

 private:
  AtomicFile() = default;
  tl::unexpected<Error> failure(int error_number) const;
  Expected<void> send();
  int give_name(int descriptor);

  std::string path_;       // as the user named it
  std::string target_;     // where its links lead
  std::string temporary_;  // its name until then; empty: none
  bool replaces_ = true;   // false: what is there is sent the content
  int descriptor_ = -1;    // ... through this open descriptor of ours; -1: through its name
  std::FILE* file_ = nullptr;
};

/// Makes `path` a file of exactly these bytes, as AtomicFile does.
Expected<void> write_file_atomically(const std::string& path, std::span<const std::byte> bytes);
Expected<void> write_file_atomically(const std::string& path, std::string_view text);

/// Fails as write_file_atomically would for want of a directory or of the right to write, without
/// writing: so that work of minutes does not end in a path that was mistyped.
Expected<void> check_writable(const std::string& path);

/// For signal handlers of programs, which must end the process afterwards: removes what unfinished
/// files have a temporary name, and keeps any more from getting one. Safe in a handler.
void discard_unfinished_files() noexcept;

}  // namespace lambent
