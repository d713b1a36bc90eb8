// SPDX-License-Identifier: Apache-2.0
// Boxes of fog in the extras of nodes. No errors: invalid ones are ignored with a warning.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Fills Document::node_fog.
void read_node_fog(Document& document, const nlohmann::json& root);

/// Adds the fog of a node, if any, to the scene, placed by the node's transform.
void place_fog(Document& document, int node, const glm::mat4& world_from_node, Scene& scene);

}  // namespace lambent::gltf
