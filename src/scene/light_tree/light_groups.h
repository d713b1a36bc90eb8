// SPDX-License-Identifier: Apache-2.0
// A light tree with up to eight children per node, from which lights are picked.
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
  /// Assigns the nodes of a tree to groups. In `tree`, children come after their parents.
  void build(std::span<const LightTreeNode> tree);
  /// Copies the nodes of a tree whose bounds or intensities have changed.
  void fit(std::span<const LightTreeNode> tree);

  /// kLightGroupSize nodes per group.
  const std::vector<LightTreeNode>& nodes() const { return nodes_; }
  /// The kGroupFloats floats of a group.
  const float* numbers(std::uint32_t group) const { return numbers_.data() + group * kGroupFloats; }
  /// The numbers of all groups.
  GroupNumbers all_numbers() const {
    return {numbers_.data(), static_cast<uint>(numbers_.size() / kGroupFloats)};
  }
  /// The place of a node of the tree: group * kLightGroupSize + child; kNowhere if it is in none.
  std::uint32_t place_of(std::uint32_t node) const { return places_[node]; }
  static constexpr std::uint32_t kNowhere = 0xFFFFFFFFu;

 private:
  std::vector<std::uint32_t> members_;  // nodes of the tree, kLightGroupSize per group
  std::vector<std::uint32_t> places_;
  std::vector<LightTreeNode> nodes_;
  AlignedFloats numbers_;
};

}  // namespace lambent
