// SPDX-License-Identifier: Apache-2.0
// Reads animations and the extras of nodes from the JSON. No errors: invalid parts are dropped with
// a warning.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Fills Document::animations.
void read_channels(Document& document, const nlohmann::json& root);

/// Fills Document::node_flags.
void read_node_flags(Document& document, const nlohmann::json& root);

}  // namespace lambent::gltf
