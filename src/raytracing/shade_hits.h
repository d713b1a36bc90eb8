// SPDX-License-Identifier: Apache-2.0
// What rays bring back, but for the light that only the irradiance field knows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raytracing/direct_light.h"
#include "raytracing/raytracer.h"
#include "raytracing/shaded_hit.h"
#include "raytracing/solid_sides.h"

namespace lambent {

/// A point that a ray met, lit directly. Where the ray left the scene, the point is the ray's
/// origin with normals against its direction.
struct ShadedHit {
  LitPoint point;
  ShadedHitRecord surface;
  glm::vec3 direct_irradiance;  ///< From lights and emissive surfaces [W/m^2].
};

/// How hits are shaded.
struct ShadeHitsSettings {
  float cone_width =
      0.0f;  ///< Width of a ray's cone per metre, which picks MIP levels; 0: full resolution.
  float max_albedo = 1.0f;  ///< Albedo is clamped to this, 0 to 1.
  /// Samples of the light tree a hit, of emissive triangles and of lights where these are many, >=
  /// 1; a shadow ray each.
  int emissive_samples = 1;
  /// Candidates among which the samples of a hit choose, in all, 1 to kMostPicks. Each costs a pick
  /// and a point on a light, but no ray; more make less noise. See candidates_per_sample().
  uint candidates = kCandidates;
  /// Directional, point and spot lights are left out. Read by HitShading::reflected_light alone.
  bool emitters_alone = false;
  /// A ray that meets a side that bounds solid matter comes from inside it and does not count;
  /// null: all rays count. It must outlive the shading.
  const SolidSides* solid_sides = nullptr;
  std::uint32_t salt = 0;  ///< Of the random numbers; with a hit's index it makes them its own.
  std::uint32_t seed = 1;
};

/// A point whose direct light is asked for, and the hit's index, which picks its random numbers.
struct DirectLightQuery {
  LitPoint point;
  std::size_t index;
};

/// Shadow rays and their stakes; kept between calls to save allocations.
struct ShadeHitsScratch {
  struct PendingLight {
    std::size_t query;
    glm::vec3 irradiance;
  };
  std::vector<DirectLightQuery> queries;
  std::vector<std::size_t> hits;  // of the queries
  std::vector<glm::vec3> direct;  // their answers
  std::vector<Ray> shadow_rays;
  std::vector<PendingLight> pending;
  ShadowRays shadows;
  std::vector<Ray> to_hits;        // the rays, each up to its hit
  std::vector<glm::vec3> through;  // share of light that passes along these
};

/// Direct irradiance [W/m^2] at points, as shade_hits finds it for a hit of the same index. Spans
/// have the same length. Single-threaded. Returns the shadow rays traced.
std::size_t direct_irradiance(const World& world, std::span<const DirectLightQuery> queries,
                              const ShadeHitsSettings& settings, ShadeHitsScratch& scratch,
                              std::span<glm::vec3> irradiance);

/// Shades the hits of rays; all spans have the same length. `first_index` is the index of the first
/// ray among all. Single-threaded. Returns the shadow rays traced.
std::size_t shade_hits(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                       const ShadeHitsSettings& settings, std::size_t first_index,
                       ShadeHitsScratch& scratch, std::span<ShadedHit> shaded);

}  // namespace lambent
