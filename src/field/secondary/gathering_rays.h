// SPDX-License-Identifier: Apache-2.0
// Rays that gather light on the processor, the light at their hits, and the secondary gathers that
// follow them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "field/probes/probe_grid.h"
#include "lambent/field.h"
#include "raytracing/raytracer.h"
#include "raytracing/shade_hits.h"

namespace lambent {

/// How the hits of gathering rays are lit.
struct HitLighting {
  const World& world;
  /// Grids of the field's volumes. Hits are near where rays are shorter than their spacing.
  std::span<const ProbeGrid> grids;
  /// Its salt is that of the gathering rays; see gather_salt().
  ShadeHitsSettings shading;
  int max_secondary_rays = 0;  ///< Secondary gathers that may follow each ray; 0: none.
  /// Looks up the field's irradiance [W/m^2]. Returns the number of rays traced.
  std::function<std::uint64_t(std::span<const FieldQuery>, std::span<glm::vec3>)> look_up;
};

/// How the hits of rays are shaded that gather a hemisphere's light, so many from each point.
/// `max_albedo`: see FieldSettings.
ShadeHitsSettings gathering_shading(int rays, float max_albedo, std::uint32_t salt,
                                    std::uint32_t seed);

/// Rays, and what they found. After light(), all have the same length.
struct GatheringRays {
  std::vector<Ray> rays;
  std::vector<std::size_t> indices;  ///< Among all rays of the picture or update.
  std::vector<ShadedHit> shaded;
  /// Indirect irradiance at the hits, from the field or by a secondary gather [W/m^2]; 0 where the
  /// hit reflects none.
  std::vector<glm::vec3> arrives;

  void add(const glm::vec3& origin_ws, const glm::vec3& direction_ws, std::size_t index);

  /// Traces the rays and finds the light at their hits. Single-threaded. Returns the number of rays
  /// traced.
  std::uint64_t light(const HitLighting& by, ShadeHitsScratch& scratch);
};

}  // namespace lambent
