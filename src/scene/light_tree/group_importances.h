// SPDX-License-Identifier: Apache-2.0
// Computes the importances of all nodes of a group at once.
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

/// LightTreeNode::link of a node of a group.
inline uint link_in_group(const float* group, uint child) {
  return floatBitsToUint(group[kGroupNumbers * kLightGroupSize + child]);
}

}  // namespace lambent
