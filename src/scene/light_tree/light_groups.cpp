// SPDX-License-Identifier: Apache-2.0
// Based on: Dammertz, Hanika and Keller, "Shallow Bounding Volume Hierarchies for Fast SIMD Ray
// Tracing of Incoherent Rays", EGSR 2008.
#include "scene/light_tree/light_groups.h"

namespace lambent {
namespace {

bool is_leaf(const LightTreeNode& node) {
  return (node.link & kLightTreeLeaf) != 0;
}

/// The number of lights below each node.
std::vector<std::uint32_t> lights_below(std::span<const LightTreeNode> tree) {
  std::vector<std::uint32_t> lights(tree.size(), 1);
  for (std::size_t i = tree.size(); i-- > 0;) {
    if (!is_leaf(tree[i])) lights[i] = lights[tree[i].link] + lights[tree[i].link + 1];
  }
  return lights;
}

/// Whether a node of a group should be replaced by its children before another one: first the
/// largest of those that do not fit into a group, so that trees are shallow; then the smallest, so
/// that few groups are nearly empty.
bool is_opened_before(std::uint32_t lights, std::uint32_t others) {
  const bool fits = lights <= kLightGroupSize, other_fits = others <= kLightGroupSize;
  if (fits != other_fits) return other_fits;
  return fits ? lights < others : lights > others;
}

/// The nodes below `node` that form a group, or `node` itself if it is a leaf.
std::vector<std::uint32_t> group_below(std::span<const LightTreeNode> tree,
                                       std::span<const std::uint32_t> lights, std::uint32_t node) {
  std::vector<std::uint32_t> group = {node};
  while (group.size() < kLightGroupSize) {
    std::size_t next = group.size();
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (is_leaf(tree[group[i]])) continue;
      if (next == group.size() || is_opened_before(lights[group[i]], lights[group[next]])) next = i;
    }
    if (next == group.size()) break;
    const std::uint32_t first = tree[group[next]].link;
    group[next] = first;
    group.push_back(first + 1);
  }
  return group;
}

}  // namespace

void LightGroups::build(std::span<const LightTreeNode> tree) {
  members_.clear();
  places_.assign(tree.size(), kNowhere);
  const std::vector<std::uint32_t> lights = lights_below(tree);
  std::vector<std::uint32_t> roots;  // of groups
  if (!tree.empty()) roots.push_back(0);
  for (std::size_t g = 0; g < roots.size(); ++g) {
    std::vector<std::uint32_t> group = group_below(tree, lights, roots[g]);
    for (const std::uint32_t node : group) {
      places_[node] = static_cast<std::uint32_t>(members_.size());
      members_.push_back(node);
      if (!is_leaf(tree[node])) roots.push_back(node);
    }
    members_.resize((g + 1) * kLightGroupSize, kNowhere);
  }
  // The groups below nodes are in the order of these nodes
  nodes_.assign(members_.size(), LightTreeNode{});
  std::uint32_t below = 1;
  for (std::size_t place = 0; place < members_.size(); ++place) {
    if (members_[place] == kNowhere) continue;
    const LightTreeNode& node = tree[members_[place]];
    nodes_[place].link = is_leaf(node) ? node.link : below++;
  }
  numbers_.assign(members_.size() / kLightGroupSize * kGroupFloats, 0.0f);
}

void LightGroups::fit(std::span<const LightTreeNode> tree) {
  for (std::size_t place = 0; place < members_.size(); ++place) {
    if (members_[place] == kNowhere) continue;
    const std::uint32_t link = nodes_[place].link;
    nodes_[place] = tree[members_[place]];
    nodes_[place].link = link;
    store_in_group(nodes_[place], place % kLightGroupSize,
                   numbers_.data() + place / kLightGroupSize * kGroupFloats);
  }
}

}  // namespace lambent
