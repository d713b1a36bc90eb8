// SPDX-License-Identifier: Apache-2.0
// What a camera sees, as points that ask for light.
#pragma once

#include <vector>

#include "lambent/world.h"
#include "raytracing/direct_light.h"

namespace lambent {

/// A point that the camera sees.
struct SeenPoint {
  LitPoint point;
  float emission = 0.0f;  ///< Largest channel of the radiance that it emits [W/(m^2 sr)].
};

/// What the camera sees on a coarse grid over a picture of 16:9, and how much of it is sky.
struct SeenView {
  std::vector<SeenPoint> points;
  float sky_share = 0.0f;
};
SeenView pass_moving_surfaces(const World& world, const Camera& camera);

/// How the light of a view's points comes about.
struct ViewLight {
  float lit_by_emission = 0.0f;  ///< Share of the points that emissive surfaces light, directly or
                                 ///< after a bounce; those that emit themselves do not count.
  float emission_ratio = 0.0f;   ///< Median radiance that those would reflect if they were white,
                                 ///< over the mean radiance of the emitters that the camera sees;
                                 ///< infinite where it sees none.
  float sky_visibility = 0.0f;   ///< Share of the points' cosine-weighted hemispheres that is open.
};
ViewLight measure_view_light(const World& world, const SeenView& view);

/// Share of the sphere around the camera that surfaces close.
float enclosure(const World& world, const Camera& camera);

}  // namespace lambent
