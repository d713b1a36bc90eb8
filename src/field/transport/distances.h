// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "field/transport/blend.h"
#include "field/transport/blend_math.h"
#include "field/transport/surfels.h"

namespace lambent {

/// How far a ray saw.
struct SeenDistance {
  float distance;  ///< [m]; infinite: the ray left the scene.
  bool back_face;  ///< It met the back of a single-sided surface.
};

/// Distances of rays, blended to what a tile's texels hold.
class DistanceBlend {
 public:
  DistanceBlend(const FieldSettings& settings, std::span<const vec3> directions);

  /// Mean distance [m] and mean squared distance [m^2] along each interior texel's direction, from
  /// one distance a ray, cut at `farthest`. All zero where so many rays meet back faces that the
  /// probe must stand in solid matter.
  void moments(std::span<const SeenDistance> seen, float farthest, std::span<vec2> moments) const;

  int rays() const { return blend_.rays(); }
  int texels() const { return blend_.texels(); }  ///< Of a tile, without gutter.

 private:
  BlendMatrix blend_;
  std::vector<vec2> totals_;  // what all rays together weigh in each texel
};

/// Blends the distances that a group's rays met into the store. `shares` holds one number a probe
/// of the group: the part of the new values, 0 to 1.
void blend_distances(const Scene& scene, const DistanceBlend& blend, const TraceGroup& group,
                     std::span<const float> blend_weights, uint dither_seed, ProbeStore& store);

}  // namespace lambent
