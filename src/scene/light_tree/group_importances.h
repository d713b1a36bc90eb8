// SPDX-License-Identifier: Apache-2.0
// Picks lights from the groups of a tree; the importances of all nodes of a group are computed at
// once.
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/light_tree/light_visibility_math.h"

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

/// The groups of a tree, kGroupFloats each, as they are seen from a surface.
struct GroupNumbers {
  const float* first;
  uint count;
  /// Weights of the visibility of the nodes of the first kGroupsWithVisibility groups; null: 1.
  const std::uint8_t* weights = nullptr;

  const float* at(uint group) const { return first + group * kGroupFloats; }
};

/// Weight of the visibility of a node of a group; 1 where none is known.
inline float visibility_in_groups(const GroupNumbers& tree, uint group, uint child) {
  const bool known = tree.weights != nullptr && group < kGroupsWithVisibility;
  return known ? visibility_weight(tree.weights[group * kLightGroupSize + child]) : 1.0f;
}

/// pick_lights(), pick_below(), fluence() and bounded_lobe() of light_tree.inl.h; the same
/// bits on all instruction sets.
void pick_in_groups(const GroupNumbers& tree, const vec3& position_ws, const vec3& normal_ws,
                    const PickLobe& lobe, uint count, LightPicks& picks);
void pick_below_in_groups(const GroupNumbers& tree, uint link, const vec3& position_ws,
                          const vec3& normal_ws, const PickLobe& lobe, uint count,
                          LightPicks& picks);
float fluence_in_groups(const GroupNumbers& tree, const vec3& position_ws);
PickLobe bounded_in_groups(const GroupNumbers& tree, const vec3& position_ws, const vec3& normal_ws,
                           const PickLobe& lobe);

/// LightTreeNode::link of a node of a group.
inline uint link_in_group(const float* group, uint child) {
  return floatBitsToUint(group[kGroupNumbers * kLightGroupSize + child]);
}

}  // namespace lambent
