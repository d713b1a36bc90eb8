// SPDX-License-Identifier: Apache-2.0
// Points that a camera sees, and where their light comes from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lambent/world.h"
#include "raytracing/direct_light.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// A point that the camera sees.
struct SeenPoint {
  LitPoint point;
  float emission = 0.0f;  ///< Largest channel of its emitted radiance [W/(m^2 sr)].
  bool unlit = false;     ///< Its material is.
};

/// What the camera sees, sampled on a coarse grid over a picture of 16:9.
struct SeenView {
  std::vector<SeenPoint> points;  ///< Samples that show a surface.
  float sky_share = 0.0f;         ///< Share of the samples that show the sky, also through glass.
};
/// Samples what the camera sees.
SeenView sample_view(const World& world, const Camera& camera);

/// Statistics of the light at a view's points. Where few of them are unlit, unlit surfaces light
/// none.
struct ViewLight {
  float lit_by_emission =
      0.0f;                     ///< Share of the points that emissive surfaces light, directly or
                                ///< after a bounce; points that emit light themselves do not count.
  float emission_ratio = 0.0f;  ///< Median radiance that those would reflect if they were white,
                                ///< over the mean radiance of the emitters that the camera sees;
                                ///< infinite where it sees none.
  float evenness = 0.0f;        ///< First quartile of what those receive, over its ninth decile.
  float emitter_radiance = 0.0f;  ///< Mean over the emitters that the camera sees [W/(m^2 sr)].
  /// Largest radiance of the emitters whose light reaches the points, directly or after a bounce
  /// [W/(m^2 sr)].
  float brightest_emitter = 0.0f;
  float sky_visibility = 0.0f;  ///< Share of the points' cosine-weighted hemispheres that is open.
};
ViewLight measure_view_light(const World& world, const SeenView& view);

/// 1 for each of the rays' hits that one of the scene's lights reaches, chosen at random, each as
/// likely as all emissive surfaces together; all 0 where the scene has no light.
std::vector<std::uint8_t> find_lit(const World& world, std::span<const Ray> rays,
                                   std::span<const Hit> hits);

/// Share of the directions around the camera in which there is a surface.
float enclosure(const World& world, const Camera& camera);

}  // namespace lambent
