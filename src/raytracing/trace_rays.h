// SPDX-License-Identifier: Apache-2.0
// Traces rays on all cores.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// The nearest hit of each ray, in their order.
std::vector<Hit> trace(const World& world, std::span<const Ray> rays);

/// The next hit of each ray beyond its `first` one, at most `reach` farther [m]; rays that missed
/// miss again.
std::vector<Hit> trace_behind(const World& world, std::vector<Ray> rays, std::span<const Hit> first,
                              float reach = kInfiniteDistance);

/// 1 for each occluded ray, 0 for the others, in their order.
std::vector<std::uint8_t> trace_occlusion(const World& world, std::span<const Ray> rays);

}  // namespace lambent
