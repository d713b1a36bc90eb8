// SPDX-License-Identifier: Apache-2.0
// Picks lights from the groups of a tree; the importances of all nodes of a group are computed at
// once.
#pragma once

#include <cstddef>

#include "scene/light_tree/light_tree_math.h"

namespace lambent {

/// Layout of a group: each number of struct ClusterNumbers for all of its nodes; then the bits of
/// their links; then padding to the end of a cache line.
inline constexpr std::size_t kGroupNumbers = 14;
inline constexpr std::size_t kGroupFloats = 16 * kLightGroupSize;

/// Stores a node as child number `child` of a group.
void store_in_group(const LightTreeNode& node, std::size_t child, float* group);

/// light_importance of each node of a group for a point with this unit normal; the same bits on all
/// instruction sets.
void group_importances(const float* group, const vec3& position_ws, const vec3& normal_ws,
                       const PickLobe& lobe, float* importances);

/// The groups of a tree, kGroupFloats each.
struct GroupNumbers {
  const float* first;
  uint count;

  const float* at(uint group) const { return first + group * kGroupFloats; }
};

/// pick_lights() and bounded_lobe() of light_tree.inl.h; the same bits on all instruction sets.
void pick_in_groups(const GroupNumbers& tree, const vec3& position_ws, const vec3& normal_ws,
                    const PickLobe& lobe, uint count, LightPicks& picks);
PickLobe bounded_in_groups(const GroupNumbers& tree, const vec3& position_ws, const vec3& normal_ws,
                           const PickLobe& lobe);

/// LightTreeNode::link of a node of a group.
inline uint link_in_group(const float* group, uint child) {
  return floatBitsToUint(group[kGroupNumbers * kLightGroupSize + child]);
}

}  // namespace lambent
