// SPDX-License-Identifier: Apache-2.0
// The node hierarchy: the nodes of a scene, and their transforms.
#pragma once

#include <glm/glm.hpp>

#include "scene/gltf/document/document.h"

namespace lambent::gltf {

struct NodeTree {
  std::vector<glm::dmat4> world_from_node;  ///< One per node of the file; finite and affine.
  glm::dvec3 origin{0.0};    ///< Origin of that world, in the file's coordinates [m].
  std::vector<int> order;    ///< All nodes of the file, parents before children.
  std::vector<int> parents;  ///< Parent of each node of the file; -1: none.
  int scene = -1;            ///< The chosen scene; -1: the file has none.
  std::vector<int> visible;  ///< Nodes of the chosen scene, parents before children, in file order.
};

/// Builds the tree. Fails on cycles, nodes with two parents and transforms that are not finite.
/// `scene` is an index, or -1 for the file's default.
Expected<NodeTree> build_node_tree(Document& document, int scene);

/// Moves the world so that its origin is at `origin` in the file's coordinates.
void move_origin(NodeTree& tree, const glm::dvec3& origin);

}  // namespace lambent::gltf
