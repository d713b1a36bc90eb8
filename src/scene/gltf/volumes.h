// SPDX-License-Identifier: Apache-2.0
// Probe volumes in the extras of nodes. No errors: invalid ones are ignored with a warning. Whether
// a field supports such volumes is checked when one is made.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Fills Document::node_volumes.
void read_node_volumes(Document& document, const nlohmann::json& root);

/// Adds the volume of a node, if any, to the scene, placed by the node's transform.
void place_volume(Document& document, int node, const glm::mat4& world_from_node, Scene& scene);

}  // namespace lambent::gltf
