// SPDX-License-Identifier: Apache-2.0
#include "core/files/file_bytes.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>

namespace lambent {

Expected<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t max_bytes) {
  if (path.empty()) return fail("", "", "the name of the file to read is empty");
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return fail(path, "", "no such file");
  if (std::filesystem::is_directory(status)) return fail(path, "", "is a directory, not a file");
  if (!std::filesystem::is_regular_file(status)) return fail(path, "", "is not a regular file");

  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return fail(path, "", error.message());
  if (size > max_bytes) {
    return fail(path, "",
                "file of " + std::to_string(size) + " bytes exceeds the limit of " +
                    std::to_string(max_bytes));
  }

  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return fail(path, "", std::generic_category().message(errno));
  std::vector<std::byte> bytes;
  try {
    bytes.resize(size);
  } catch (const std::bad_alloc&) {
    return fail(path, "", "not enough memory to read the file", Error::Kind::failed);
  }
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    return fail(path, "", "could not be read to its end", Error::Kind::failed);
  }
  return bytes;
}

}  // namespace lambent
