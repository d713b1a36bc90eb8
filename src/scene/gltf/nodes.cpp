// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/nodes.h"

#include <cmath>

#include "scene/animation/pose.h"

namespace lambent::gltf {
namespace {

// Deeper than any rig; a chain this long is an attack or a broken exporter.
constexpr int kMaxNodeDepth = 4096;

glm::dmat4 parent_from_node(Document& document, int index) {
  const tinygltf::Node& node = document.model.nodes[index];
  if (node.matrix.size() == 16) {
    glm::dmat4 matrix(1.0);
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[i];
    const bool affine =
        matrix[0].w == 0.0 && matrix[1].w == 0.0 && matrix[2].w == 0.0 && matrix[3].w == 1.0;
    if (!affine) {
      document.repaired("node matrices were made affine", 1, entry("nodes", index));
      for (int column = 0; column < 4; ++column) matrix[column].w = column == 3 ? 1.0 : 0.0;
    }
    return matrix;
  }
  const auto numbers = [](const std::vector<double>& values) {
    return values.empty() ? nullptr : values.data();
  };
  return compose_transform(numbers(node.translation), numbers(node.rotation), numbers(node.scale));
}

bool finite(const glm::mat4& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  }
  return true;
}

// The parent of each node, or -1. Fails where a node has two.
Expected<std::vector<int>> find_parents(const Document& document) {
  const auto& nodes = document.model.nodes;
  std::vector<int> parents(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      if (child == static_cast<int>(i) || parents[child] >= 0) {
        return document.fail_at(entry("nodes", child), child == static_cast<int>(i)
                                                           ? "the node is its own child"
                                                           : "the node has more than one parent");
      }
      parents[child] = static_cast<int>(i);
    }
  }
  return parents;
}

// Appends a node and all of its descendants, parents first. Iterative, so that depth costs no
// stack.
void append_subtree(const Document& document, int root, std::vector<bool>& seen,
                    std::vector<int>& order) {
  std::vector<int> pending = {root};
  while (!pending.empty()) {
    const int node = pending.back();
    pending.pop_back();
    if (seen[node]) continue;
    seen[node] = true;
    order.push_back(node);
    const auto& children = document.model.nodes[node].children;
    pending.insert(pending.end(), children.rbegin(), children.rend());
  }
}

Expected<int> chosen_scene(const Document& document, int scene) {
  const tinygltf::Model& model = document.model;
  if (scene >= static_cast<int>(model.scenes.size())) {
    return document.fail_at(entry("scenes", scene),
                            "does not exist: the file has " + std::to_string(model.scenes.size()));
  }
  if (scene < 0) scene = model.defaultScene;
  if (scene < 0 && !model.scenes.empty()) scene = 0;
  return scene;
}

// The specification allows only nodes without parents as roots. One that has a parent is
// nevertheless placed by its parents, and imported with all of its descendants.
std::vector<int> roots_of(Document& document, int scene, const std::vector<int>& parents) {
  if (scene >= 0) {
    const std::vector<int>& roots = document.model.scenes[scene].nodes;
    for (const int root : roots) {
      if (parents[root] < 0) continue;
      document.repaired(
          "roots of the scene are children of other nodes and stand where these put "
          "them",
          1, entry("nodes", root));
    }
    return roots;
  }
  document.warn("The file has no scene; all of its nodes are shown.");
  std::vector<int> roots;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] < 0) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

}  // namespace

Expected<NodeTree> build_node_tree(Document& document, int scene) {
  const std::size_t count = document.model.nodes.size();
  LAMBENT_TRY(parents, find_parents(document));

  // Order all nodes of the file, since a joint may be outside the scene that contains its mesh
  std::vector<bool> seen(count, false);
  NodeTree tree;
  std::vector<int>& order = tree.order;
  for (std::size_t i = 0; i < count; ++i) {
    if (parents[i] < 0) append_subtree(document, static_cast<int>(i), seen, order);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!seen[i]) return document.fail_at(entry("nodes", i), "the node is part of a cycle");
  }

  std::vector<glm::dmat4>& world_from_node = tree.world_from_node;
  world_from_node.assign(count, glm::dmat4(1.0));
  std::vector<int> depth(count, 0);
  for (const int node : order) {
    world_from_node[node] = parent_from_node(document, node);
    if (const int parent = parents[node]; parent >= 0) {
      world_from_node[node] = world_from_node[parent] * world_from_node[node];
      depth[node] = depth[parent] + 1;
    }
    if (depth[node] > kMaxNodeDepth) {
      return document.fail_at(entry("nodes", node), "the hierarchy is absurdly deep");
    }
    if (!finite(glm::mat4(world_from_node[node]))) {
      return document.fail_at(entry("nodes", node), "the transform is not finite");
    }
  }

  LAMBENT_TRY(chosen, chosen_scene(document, scene));
  tree.scene = chosen;
  seen.assign(count, false);
  for (const int root : roots_of(document, chosen, parents))
    append_subtree(document, root, seen, tree.visible);
  tree.parents = std::move(parents);
  return tree;
}

void move_origin(NodeTree& tree, const glm::dvec3& origin) {
  const glm::dvec4 way(origin - tree.origin, 0.0);
  for (glm::dmat4& world_from_node : tree.world_from_node) world_from_node[3] -= way;
  tree.origin = origin;
}

}  // namespace lambent::gltf
