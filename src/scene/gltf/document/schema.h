// SPDX-License-Identifier: Apache-2.0
// Checks the structure of a glTF file's JSON against the specification, before anything reads it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lambent/error.h"

namespace lambent::gltf {

/// Checks types, ranges, lengths and indices of everything that the importer reads. Fails with the
/// place of the first thing wrong; but numbers of materials and lights that are out of range are
/// brought into it. Returns the places of these.
Expected<std::vector<std::string>> check_schema(nlohmann::json& root, const std::string& file);

}  // namespace lambent::gltf
