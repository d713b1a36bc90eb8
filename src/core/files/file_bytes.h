// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lambent/error.h"

namespace lambent {

/// Files above this [bytes] are refused before anything is allocated; images are far smaller.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;

/// All bytes of a regular file. Fails when it is missing, not a file, unreadable or above
/// `max_bytes`.
Expected<std::vector<std::byte>> read_file(const std::string& path,
                                           std::uint64_t max_bytes = kMaxFileBytes);

}  // namespace lambent
