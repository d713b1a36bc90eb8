// SPDX-License-Identifier: Apache-2.0
// Probe volumes that a file's author asks for in the extras of nodes. Nothing here makes a file
// fail: what cannot be understood is ignored with a warning. Whether a field can have such volumes
// is decided where one is made.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Fills Document::node_volumes.
void read_node_volumes(Document& document, const nlohmann::json& root);

/// The volume of a node that asks for one, where the node stands.
void place_volume(Document& document, int node, const glm::mat4& world_from_node, Scene& scene);

}  // namespace lambent::gltf
