// SPDX-License-Identifier: Apache-2.0
// importances_in_group and pick_in_groups for one instruction set: see core/simd_levels.h.
#include "core/lanes.inl.h"

LAMBENT_FORCE_INLINE Lanes root(const Lanes& x) {
  alignas(sizeof(Lanes)) float roots[kLanes];
  store(roots, x);
  for (float& e : roots) e = std::sqrt(e);
  Lanes lanes;
  load(lanes, roots);
  return lanes;
}
using lambent::max;
LAMBENT_FORCE_INLINE Lanes max(const Lanes& a, float b) {
  const Lanes other = Lanes{} + b;
  return a > other ? a : other;
}
LAMBENT_FORCE_INLINE Lanes abs(const Lanes& x) {
  return x < 0.0f ? -x : x;
}
LAMBENT_FORCE_INLINE vec3 abs(const vec3& v) {
  return lambent::abs(v);
}

#define Real Lanes
#define LAMBENT_REAL_FN LAMBENT_FORCE_INLINE
#include "scene/light_tree/light_importance.inl.h"
#undef Real
#undef LAMBENT_REAL_FN

static void importances_in_group(const float* group, const vec3& position_ws, const vec3& normal_ws,
                                 const PickLobe& lobe, float* importances) {
  static_assert(sizeof(ClusterNumbers) == kGroupNumbers * sizeof(Lanes));
  // Loaded one by one: g++ 12 copies all of them at once by a string move, a fifth of a pick's time
  const auto at = [group](int number) {
    Lanes lanes;
    load(lanes, group + number * kLanes);
    return lanes;
  };
  const ClusterNumbers n = {at(0), at(1), at(2), at(3),  at(4),  at(5),  at(6),
                            at(7), at(8), at(9), at(10), at(11), at(12), at(13)};
  store(importances, importance_of(n, position_ws, normal_ws, lobe));
}

// The types and functions that light_tree.inl.h requires.
using LightTreeRef = const GroupNumbers&;

LAMBENT_FORCE_INLINE uint light_tree_size(const GroupNumbers& tree) {
  return tree.count;
}
LAMBENT_FORCE_INLINE uint fetch_group_link(const GroupNumbers& tree, uint group, uint child) {
  return link_in_group(tree.at(group), child);
}
LAMBENT_FORCE_INLINE void group_importances(const GroupNumbers& tree, uint group,
                                            const vec3& position_ws, const vec3& normal_ws,
                                            const PickLobe& lobe, float* importances) {
  importances_in_group(tree.at(group), position_ws, normal_ws, lobe, importances);
}
LAMBENT_FORCE_INLINE bool knows_visibility(const GroupNumbers& tree, uint group) {
  return tree.weights != nullptr && group < kGroupsWithVisibility;
}
LAMBENT_FORCE_INLINE float fetch_visibility(const GroupNumbers& tree, uint group, uint child) {
  return visibility_in_groups(tree, group, child);
}

#include "scene/light_tree/light_tree.inl.h"

__attribute__((flatten)) static void pick_in_groups(const GroupNumbers& tree,
                                                    const vec3& position_ws, const vec3& normal_ws,
                                                    const PickLobe& lobe, uint count,
                                                    LightPicks& picks) {
  pick_lights(tree, position_ws, normal_ws, lobe, count, picks);
}

__attribute__((flatten)) static void pick_below_in_groups(const GroupNumbers& tree, uint link,
                                                          const vec3& position_ws,
                                                          const vec3& normal_ws,
                                                          const PickLobe& lobe, uint count,
                                                          LightPicks& picks) {
  pick_below(tree, link, position_ws, normal_ws, lobe, count, picks);
}

__attribute__((flatten)) static float fluence_in_groups(const GroupNumbers& tree,
                                                        const vec3& position_ws) {
  return fluence(tree, position_ws);
}

__attribute__((flatten)) static PickLobe bounded_in_groups(const GroupNumbers& tree,
                                                           const vec3& position_ws,
                                                           const vec3& normal_ws,
                                                           const PickLobe& lobe) {
  return bounded_lobe(tree, position_ws, normal_ws, lobe);
}
