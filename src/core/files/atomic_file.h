// SPDX-License-Identifier: Apache-2.0
// Atomic writing of files: a file is complete, or it does not appear.
//
// Where the system supports it (O_TMPFILE), a file is written without a name and gets its name when
// it is complete. Whatever ends the program before, be it a signal, a crash or a loss of power,
// leaves nothing behind, without handlers and cleanup. Elsewhere (NFS, FAT) it has a temporary name
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

/// A file that is being written. Without commit() it does not appear, and an existing file is not
/// changed.
class AtomicFile {
 public:
  /// How the file is stored until it is complete: without a name where the system supports it, or
  /// with a temporary name.
  enum class Unfinished { nameless_if_possible, named };

  /// Begins the file. A symbolic link is followed and not replaced, even if its target does not
  /// exist yet. Devices, pipes and open descriptors (/dev/null, /dev/stdout) cannot be replaced:
  /// the whole content is written to them on commit. Fails with bad_input on an empty name and on a
  /// directory, else with failed.
  static Expected<AtomicFile> open(const std::string& path,
                                   Unfinished how = Unfinished::nameless_if_possible);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) = delete;
  ~AtomicFile();

  /// Appends at the current position. After a failure, only destroy the object.
  Expected<void> write(std::span<const std::byte> bytes);
  /// Moves to a position [bytes from the start] to overwrite what was written there.
  Expected<void> seek(std::uint64_t position);
  /// The path as the user gave it.
  const std::string& path() const { return path_; }

  /// Replaces the target by what was written. Fails also where the disk is full; nothing remains
  /// then.
  Expected<void> commit();

 private:
  AtomicFile() = default;
  tl::unexpected<Error> failure(int error_number) const;
  Expected<void> send();
  int give_name(int descriptor);

  std::string path_;       // as the user gave it
  std::string target_;     // where its links lead
  std::string temporary_;  // name until commit; empty: none
  bool replaces_ = true;   // false: the content is written to the existing target
  int descriptor_ = -1;  // open descriptor of this process to which it is written; -1: by its name
  std::FILE* file_ = nullptr;
};

/// Makes `path` a file of exactly these bytes, as AtomicFile does.
Expected<void> write_file_atomically(const std::string& path, std::span<const std::byte> bytes);
Expected<void> write_file_atomically(const std::string& path, std::string_view text);

/// Fails as write_file_atomically would if the directory is missing or not writable, without
/// writing, so that minutes of work are not lost to a mistyped path.
Expected<void> check_writable(const std::string& path);

/// For signal handlers of programs, which must end the process afterwards: removes unfinished files
/// that have a temporary name, and prevents new ones. Safe in a handler.
void discard_unfinished_files() noexcept;

}  // namespace lambent
