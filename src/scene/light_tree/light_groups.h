// SPDX-License-Identifier: Apache-2.0
// A light tree in groups: nodes of up to eight children, as lights are picked from it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/large_pages.h"
#include "scene/light_tree/group_importances.h"

namespace lambent {

/// The groups of a binary tree. Group 0 holds the children of the root, or the root if that is a
/// leaf.
class LightGroups {
 public:
  /// Which nodes are in which group. Children come after their parents.
  void build(std::span<const LightTreeNode> tree);
  /// Takes over what the nodes of the tree are now.
  void fit(std::span<const LightTreeNode> tree);

  /// kLightGroupSize a group.
  const std::vector<LightTreeNode>& nodes() const { return nodes_; }
  /// kGroupFloats a group.
  const float* numbers(std::uint32_t group) const { return numbers_.data() + group * kGroupFloats; }
  /// The place of a node of the tree: group * kLightGroupSize + child; kNowhere if it is in none.
  std::uint32_t place_of(std::uint32_t node) const { return places_[node]; }
  static constexpr std::uint32_t kNowhere = 0xFFFFFFFFu;

 private:
  std::vector<std::uint32_t> members_;  // nodes of the tree, kLightGroupSize a group
  std::vector<std::uint32_t> places_;
  std::vector<LightTreeNode> nodes_;
  AlignedFloats numbers_;
};

}  // namespace lambent
