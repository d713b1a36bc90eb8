// SPDX-License-Identifier: Apache-2.0
// Checks the structure of a glTF file's JSON against the specification, before anything reads it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lambent/error.h"

namespace lambent::gltf {

/// Checks types, ranges, lengths and indices of everything that the importer reads. Fails with the
/// place of the first thing wrong.
Expected<void> check_schema(const nlohmann::json& root, const std::string& file);

}  // namespace lambent::gltf
