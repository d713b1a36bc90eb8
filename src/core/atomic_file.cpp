// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>

namespace lambent {
namespace {

namespace fs = std::filesystem;

/// Names that other programs took are tried past, but not for ever.
constexpr int kMaxNameAttempts = 100;

std::string system_cause(const char* what, int error_number) {
  return std::string(what) + ": " + std::generic_category().message(error_number);
}

/// What the user can mend is bad input; a disk that is full or broken is not the user's doing.
Error::Kind kind_of(int error_number) {
  const bool environment = error_number == ENOSPC || error_number == EIO ||
                           error_number == EDQUOT || error_number == EMFILE ||
                           error_number == ENFILE;
  return environment ? Error::Kind::failed : Error::Kind::bad_input;
}

/// Writes and closes `file`. Returns 0 or the errno of what failed; errors of a full disk may only
/// show on close.
int write_and_close(std::FILE* file, std::span<const std::byte> bytes) {
  errno = 0;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = written ? 0 : (errno != 0 ? errno : EIO);
  errno = 0;
  const int close_error = std::fclose(file) == 0 ? 0 : (errno != 0 ? errno : EIO);
  return write_error != 0 ? write_error : close_error;
}

/// A new file beside `target`, opened for writing, or null with errno set. Its name goes to `name`.
std::FILE* open_temporary(const fs::path& target, fs::path& name) {
  static std::atomic<unsigned> count{std::random_device{}()};
  for (int attempt = 0; attempt < kMaxNameAttempts; ++attempt) {
    name = target;
    name += ".tmp-" + std::to_string(count.fetch_add(1));
    // C11's "x" refuses a name that exists, so two writers never share a temporary file.
    std::FILE* file = std::fopen(name.c_str(), "wbx");
    if (file != nullptr || errno != EEXIST) return file;
  }
  return nullptr;
}

}  // namespace

Expected<void> write_file_atomically(const std::string& path, std::span<const std::byte> bytes) {
  if (path.empty()) return fail("", "", "the name of the file to write is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return fail(path, "", "cannot write: is a directory");

  // Devices and pipes (/dev/null, /dev/stdout) cannot be replaced, only written to.
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    const int failure = file == nullptr ? errno : write_and_close(file, bytes);
    if (failure != 0)
      return fail(path, "", system_cause("cannot write", failure), kind_of(failure));
    return {};
  }

  // Follow links first, for a rename would replace the link itself.
  fs::path target = fs::weakly_canonical(path, error);
  if (error) target = path;

  fs::path temporary;
  std::FILE* file = open_temporary(target, temporary);
  if (file == nullptr) {
    const int failure = errno;
    return fail(path, "", system_cause("cannot write", failure), kind_of(failure));
  }
  if (const int failure = write_and_close(file, bytes); failure != 0) {
    fs::remove(temporary, error);
    return fail(path, "", system_cause("cannot write", failure), kind_of(failure));
  }
  fs::rename(temporary, target, error);
  if (error) {
    const std::error_code rename_error = error;
    fs::remove(temporary, error);
    return fail(path, "", "cannot write: " + rename_error.message(), kind_of(rename_error.value()));
  }
  return {};
}

Expected<void> check_writable(const std::string& path) {
  if (path.empty()) return fail("", "", "the name of the file to write is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return fail(path, "", "cannot write: is a directory");
  // What is written in place needs no right to its directory, what is replaced no other
  const bool in_place = fs::exists(status) && !fs::is_regular_file(status);
  fs::path written = in_place ? fs::path(path) : fs::path(path).parent_path();
  if (written.empty()) written = ".";
  if (::access(written.c_str(), W_OK) == 0) return {};
  const int failure = errno;
  return fail(path, "", system_cause("cannot write", failure), kind_of(failure));
}

Expected<void> write_file_atomically(const std::string& path, std::string_view text) {
  return write_file_atomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace lambent
