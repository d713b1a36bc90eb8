// SPDX-License-Identifier: Apache-2.0
// group_importances for one instruction set: see core/simd_levels.h.
#include "core/lanes.inl.h"

LAMBENT_FORCE_INLINE Lanes root(const Lanes& x) {
  alignas(sizeof(Lanes)) float roots[kLanes];
  store(roots, x);
  for (float& e : roots) e = std::sqrt(e);
  Lanes lanes;
  load(lanes, roots);
  return lanes;
}
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

static void group_importances(const float* group, const vec3& position_ws, const vec3& normal_ws,
                              const PickLobe& lobe, float* importances) {
  static_assert(sizeof(ClusterNumbers) == kGroupNumbers * sizeof(Lanes));
  ClusterNumbers numbers;
  __builtin_memcpy(&numbers, group, sizeof(numbers));
  store(importances, importance_of(numbers, position_ws, normal_ws, lobe));
}
