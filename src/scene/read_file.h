// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lambent/error.h"

namespace lambent {

/// The bytes of the file at `path`. Errors carry `file` and `place`: where the path was found.
Expected<std::vector<std::uint8_t>> read_file(const std::string& path, const std::string& file,
                                              const std::string& place);

}  // namespace lambent
