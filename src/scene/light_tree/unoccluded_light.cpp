// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree/unoccluded_light.h"

#include "scene/light_tree/unoccluded_math.h"

namespace lambent {
namespace {

struct LitTree {
  const LightTree& tree;
  const EmissiveTriangles& emissive;
};

// The types and functions that unoccluded_light.inl.h requires.
using LitTreeRef = const LitTree&;

uint light_tree_size(const LitTree& of) {
  return static_cast<uint>(of.tree.nodes().size());
}
const LightTreeNode& fetch_node(const LitTree& of, uint node) {
  return of.tree.nodes()[node];
}
uint emitter_count(const LitTree& of) {
  return static_cast<uint>(of.emissive.size());
}
const EmitterRecord& fetch_emitter(const LitTree& of, uint emitter) {
  return of.emissive.entries()[emitter];
}
const LightRecord& fetch_light(const LitTree& of, uint light) {
  return of.tree.lights()[light];
}

#include "scene/light_tree/unoccluded_light.inl.h"

}  // namespace

glm::vec3 unoccluded_light(const LightTree& tree, const EmissiveTriangles& emissive,
                           const glm::vec3& position_ws, const glm::vec3& normal_ws) {
  return unoccluded_light(LitTree{tree, emissive}, position_ws, normal_ws);
}

}  // namespace lambent
