// SPDX-License-Identifier: Apache-2.0
// Boxes of fog that a file's author asks for in the extras of nodes. Nothing here makes a file
// fail: what cannot be understood is ignored with a warning.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Fills Document::node_fog.
void read_node_fog(Document& document, const nlohmann::json& root);

/// The fog of a node that asks for some, where the node stands.
void place_fog(Document& document, int node, const glm::mat4& world_from_node, Scene& scene);

}  // namespace lambent::gltf
