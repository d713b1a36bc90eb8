// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree/group_importances.h"

#include "core/simd_levels.h"
#include "shared/packing.h"
#include "shared/random.h"

namespace lambent {
namespace {

// Replaces lambent::kLanes: one lane per node.
constexpr int kLanes = static_cast<int>(kLightGroupSize);

#define LAMBENT_KERNELS "scene/light_tree/importance_kernel.inl.h"
#include "core/simd_levels.inl.h"

}  // namespace

void store_in_group(const LightTreeNode& node, std::size_t child, float* group) {
  const float numbers[kGroupNumbers] = {node.center_ws.x,  node.center_ws.y,
                                        node.center_ws.z,  node.half_size.x,
                                        node.half_size.y,  node.half_size.z,
                                        node.axis_ws.x,    node.axis_ws.y,
                                        node.axis_ws.z,    node.cos_spread,
                                        node.sin_spread,   node.intensity,
                                        node.cos_emission, static_cast<float>(node.both_sides)};
  for (std::size_t i = 0; i < kGroupNumbers; ++i) group[i * kLightGroupSize + child] = numbers[i];
  group[kGroupNumbers * kLightGroupSize + child] = uintBitsToFloat(node.link);
}

void group_importances(const float* group, const vec3& position_ws, const vec3& normal_ws,
                       const PickLobe& lobe, float* importances) {
  static const auto kernel = LAMBENT_BEST_LEVEL(importances_in_group);
  kernel(group, position_ws, normal_ws, lobe, importances);
}

void pick_in_groups(const GroupNumbers& tree, const vec3& position_ws, const vec3& normal_ws,
                    const PickLobe& lobe, uint count, LightPicks& picks) {
  static const auto kernel = LAMBENT_BEST_LEVEL(pick_in_groups);
  kernel(tree, position_ws, normal_ws, lobe, count, picks);
}

void pick_below_in_groups(const GroupNumbers& tree, uint link, const vec3& position_ws,
                          const vec3& normal_ws, const PickLobe& lobe, uint count,
                          LightPicks& picks) {
  static const auto kernel = LAMBENT_BEST_LEVEL(pick_below_in_groups);
  kernel(tree, link, position_ws, normal_ws, lobe, count, picks);
}

float fluence_in_groups(const GroupNumbers& tree, const vec3& position_ws) {
  static const auto kernel = LAMBENT_BEST_LEVEL(fluence_in_groups);
  return kernel(tree, position_ws);
}

PickLobe bounded_in_groups(const GroupNumbers& tree, const vec3& position_ws, const vec3& normal_ws,
                           const PickLobe& lobe) {
  static const auto kernel = LAMBENT_BEST_LEVEL(bounded_in_groups);
  return kernel(tree, position_ws, normal_ws, lobe);
}

}  // namespace lambent
