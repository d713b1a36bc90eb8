// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "lambent/error.h"

namespace lambent {

/// Makes `path` a file of exactly these bytes, or leaves what was there untouched: writes a
/// temporary file beside it, then renames. A symbolic link keeps pointing where it did; an existing
/// device or pipe is written to in place. Fails with bad_input when the directory is missing or may
/// not be written to, with failed when the disk is; nothing temporary remains.
Expected<void> write_file_atomically(const std::string& path, std::span<const std::byte> bytes);
Expected<void> write_file_atomically(const std::string& path, std::string_view text);

/// Fails as write_file_atomically would for want of a directory or of the right to write, without writing: so that
/// work of minutes does not end in a path that was mistyped.
Expected<void> check_writable(const std::string& path);

}  // namespace lambent
