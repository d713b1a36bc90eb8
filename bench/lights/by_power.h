// SPDX-License-Identifier: Apache-2.0
// Direct light by the simplest method, as a baseline: one light drawn by power, and one shadow ray.
#pragma once

#include <span>
#include <vector>

#include "raytracing/shade_hits.h"

namespace lambent::bench {

/// Draws a light for each point in proportion to its power: point and spot lights and emissive
/// triangles alike, the latter with a point drawn by area.
class ByPower {
 public:
  explicit ByPower(const World& world);

  /// Like lambent's direct_irradiance with one sample; `round` selects the random numbers.
  void direct_irradiance(std::span<const DirectLightQuery> queries, std::uint32_t round,
                         std::span<glm::vec3> irradiance) const;

 private:
  LightCandidate draw(const LitPoint& point, RandomStream& random) const;

  const World& world_;
  std::vector<double> cumulative_;  // of the lights, then of all emissive triangles together
};

}  // namespace lambent::bench
