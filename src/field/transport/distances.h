// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "field/transport/blend.h"
#include "field/transport/blend_math.h"
#include "field/transport/surfels.h"

namespace lambent {

/// The distance to the hit of a ray.
struct RayDistance {
  float distance;    ///< [m]; infinite: the ray left the scene.
  bool from_inside;  ///< The side that the ray hit bounds solid matter.
};

/// Blends distances of rays into the moments of a tile's texels.
class DistanceBlend {
 public:
  DistanceBlend(const FieldSettings& settings, std::span<const vec3> directions);

  /// Computes the mean distance [m] and mean squared distance [m^2] of each interior texel from one
  /// distance per ray, clamped to `farthest`. All are 0 where the probe stands inside geometry.
  void moments(std::span<const RayDistance> seen, float farthest, std::span<vec2> moments) const;

  int rays() const { return blend_.rays(); }
  int texels() const { return blend_.texels(); }  ///< Texels of a tile, without gutter.

 private:
  BlendMatrix blend_;
  std::vector<vec2> totals_;  // the sum of all ray weights in each texel
};

/// Blends the distances of a group's hits into the store. `blend_weights` has one weight of the new
/// moments per probe of the group, 0 to 1.
void blend_distances(const SolidSides& solid_sides, const DistanceBlend& blend,
                     const TraceGroup& group, std::span<const float> blend_weights,
                     uint dither_seed, ProbeStore& store);

}  // namespace lambent
