// SPDX-License-Identifier: Apache-2.0
// All lights of a scene: those to which every point traces a shadow ray, and a tree from which the
// others are sampled.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/light_sampling.h"
#include "scene/light_tree/light_groups.h"
#include "scene/light_tree/light_tree_math.h"
#include "scene/light_tree/light_visibility.h"

namespace lambent {

struct LightCluster;

/// Up to this many point and spot lights are each tested with a shadow ray by every point, without
/// noise. On a processor, this many rays cost about as much as one sample of a tree with more
/// lights (`lambent_lights`). Where there are more, all of them are in the tree.
inline constexpr std::size_t kMaxLightsAsked = 16;

/// The lights of a scene. Directional lights are never in the tree, since their light does not
/// depend on the distance. Emissive triangles, and the pieces of divided ones, are always in the
/// tree.
class LightTree {
 public:
  LightTree(const Scene& scene, const EmissiveTriangles& emissive);

  /// Follows edits. Where the same lights are in the tree as before, its nodes are only refitted,
  /// until they have grown so much that a rebuild pays off.
  void update(const Scene& scene, const EmissiveTriangles& emissive);

  /// Point, spot and directional lights, as in the scene.
  const std::vector<LightRecord>& lights() const { return lights_; }
  /// Indices of the lights to which every point traces a shadow ray; the others are in the tree.
  const std::vector<std::uint32_t>& asked() const { return asked_; }

  /// Node 0 is the root; empty: nothing is in the tree. A leaf's light is the index of one of
  /// EmissiveTriangles::entries() or, from their number on, that of one of the lights above.
  const std::vector<LightTreeNode>& nodes() const { return nodes_; }
  /// Whether more than one light is in the tree.
  bool has_choice() const { return nodes_.size() > 1; }

  /// The nodes in groups, from which lights are picked.
  const LightGroups& groups() const { return groups_; }

  /// What is known of the lights' visibility, by which they are picked; empty after a build.
  const LightVisibility& visibility() const { return visibility_; }
  void set_visibility(LightVisibility visibility) { visibility_ = std::move(visibility); }

  /// Bounds a lobe for a point, as the functions below require: see bounded_lobe in
  /// light_tree.inl.h.
  PickLobe bounded(const glm::vec3& position_ws, const glm::vec3& normal_ws,
                   const PickLobe& lobe) const;

  /// Fluence rate of all lights of the tree at a point, see light_tree.inl.h [W/m^2], luminance.
  float fluence(const glm::vec3& position_ws) const;

  /// Picks a light for a point; probability 0 where none can be seen.
  LightPick pick(const glm::vec3& position_ws, const glm::vec3& normal_ws, const PickLobe& lobe,
                 float u) const;

  /// Picks several lights, at most kMostPicks, for increasing uniform numbers in LightPick::rest.
  void pick(const glm::vec3& position_ws, const glm::vec3& normal_ws, const PickLobe& lobe,
            std::uint32_t count, LightPicks& picks) const;

  /// Picks a light below a link of the groups by importance alone, whatever is visible.
  LightPick pick_below(std::uint32_t link, const glm::vec3& position_ws, const glm::vec3& normal_ws,
                       float u) const;

  /// The probability with which `pick` finds a light of the tree.
  float probability(std::uint32_t light, const glm::vec3& position_ws, const glm::vec3& normal_ws,
                    const PickLobe& lobe) const;

  /// How often the tree was built rather than refitted.
  int builds() const { return builds_; }

 private:
  /// Identifies a light from one update to the next.
  struct LightKey {
    std::uint32_t instance, triangle;  // or kPunctual and the light
    glm::vec2 piece_corner{0.0f};
    float piece_size = 0.0f;
    bool operator==(const LightKey&) const = default;
  };
  static constexpr std::uint32_t kPunctual = 0xffffffffu;

  void list_lights(const Scene& scene);
  std::vector<LightCluster> clusters_of_lights(const EmissiveTriangles& emissive) const;
  std::uint32_t light_of(std::size_t place, const EmissiveTriangles& emissive) const;
  void build(const EmissiveTriangles& emissive);
  /// `is_new`: the tree was built.
  void fit(const EmissiveTriangles& emissive, bool is_new);
  double cost() const;
  /// The groups with the weights of visibility that a surface gives them.
  GroupNumbers seen_from(const glm::vec3& position_ws, const glm::vec3& normal_ws) const;

  std::vector<LightRecord> lights_;
  std::vector<std::uint32_t> asked_, drawn_;  // of the lights
  std::vector<LightTreeNode> nodes_;
  std::vector<std::uint32_t> parents_;  // by node
  std::vector<std::uint32_t> leaves_;   // by light of the tree
  std::vector<LightKey> keys_;          // the lights of the tree
  double cost_when_built_ = 0.0;
  int builds_ = 0;
  LightGroups groups_;
  LightVisibility visibility_;
};

}  // namespace lambent
