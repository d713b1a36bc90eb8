// SPDX-License-Identifier: Apache-2.0
// Shading of rays' hits, without the light that comes from the irradiance field.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raytracing/direct_light.h"
#include "raytracing/raytracer.h"
#include "raytracing/shaded_hit.h"
#include "raytracing/solid_sides/solid_sides.h"

namespace lambent {

/// A ray's hit, with its direct light. Where the ray left the scene, the point is the ray's origin
/// with normals against its direction. Where the ray met a mirror and went on, the point is the one
/// that the mirror shows, seen from the mirror.
struct ShadedHit {
  LitPoint point;
  ShadedHitRecord surface;
  glm::vec3 direct_irradiance;  ///< From lights and emissive surfaces [W/m^2].
  /// Distance from the point to the nearest light drawn there that would shine on it if nothing
  /// were in the way [m]; infinite: none would.
  float light_distance = kInfiniteDistance;
};

/// Settings of the shading of hits.
struct ShadeHitsSettings {
  float cone_width =
      0.0f;  ///< Width of a ray's cone per metre, which picks MIP levels; 0: full resolution.
  float max_albedo = 1.0f;  ///< Bound of the mean albedo, 0 to 1.
  /// Samples of the light tree (of emissive triangles, and of lights where these are many) for each
  /// hit, >= 1; each costs a shadow ray.
  int emissive_samples = 1;
  /// Total number of candidates from which a hit's samples are resampled, 1 to kMostPicks. Each
  /// costs a pick and a point on a light, but no ray; more make less noise. See
  /// candidates_per_sample().
  uint candidates = kCandidates;
  /// Leaves out directional, point and spot lights. Read by HitShading::reflected_light alone.
  bool emitters_alone = false;
  /// Rays that hit a side that bounds solid matter come from inside it and are discounted; null:
  /// all rays count. Must outlive the shading.
  const SolidSides* solid_sides = nullptr;
  /// Rays go on at mirrors (mirrors/mirror_math.h). Each mirror costs a ray and the shading of its
  /// hit.
  bool follow_mirrors = false;
  std::uint32_t salt = 0;  ///< Salt of the random numbers; a hit's index makes them unique.
  std::uint32_t seed = 1;
};

/// A point that receives direct light, and the index of the hit, which seeds its random numbers.
struct DirectLightQuery {
  LitPoint point;
  std::size_t index;
};

/// Shadow rays and the light that they test; reused between calls to save allocations.
struct ShadeHitsScratch {
  struct PendingLight {
    std::size_t query;
    glm::vec3 irradiance;
  };
  std::vector<DirectLightQuery> queries;
  std::vector<std::size_t> hits;       // the queries' hits
  std::vector<glm::vec3> direct;       // the queries' results
  std::vector<float> light_distances;  // see ShadedHit
  std::vector<Ray> shadow_rays;
  std::vector<PendingLight> pending;
  ShadowRays shadows;
  std::vector<Ray> to_hits;          // the rays, each ending at its hit
  std::vector<glm::vec3> through;    // share of light that passes along them
  std::vector<std::size_t> indices;  // the rays' indices, where they follow each other
  /// Rays that mirrors reflect, their indices, and the hits of `shaded` from which they come.
  struct Reflected {
    std::vector<std::size_t> from, indices;
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<ShadedHit> shaded;
  } reflected;
};

/// Direct irradiance [W/m^2] at points, the same as shade_hits finds for a hit of the same index.
/// Spans have the same length. Single-threaded. Returns the number of shadow rays traced.
std::size_t direct_irradiance(const World& world, std::span<const DirectLightQuery> queries,
                              const ShadeHitsSettings& settings, ShadeHitsScratch& scratch,
                              std::span<glm::vec3> irradiance);

/// Shades the hits of rays; all spans have the same length. `indices` are those of the rays among
/// all, which make their random numbers unique. Single-threaded. Returns the number of rays traced:
/// to lights, and from mirrors.
std::size_t shade_hits(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                       const ShadeHitsSettings& settings, std::span<const std::size_t> indices,
                       ShadeHitsScratch& scratch, std::span<ShadedHit> shaded);

/// Shades the hits of rays that follow each other among all, from `first_index`.
std::size_t shade_hits(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                       const ShadeHitsSettings& settings, std::size_t first_index,
                       ShadeHitsScratch& scratch, std::span<ShadedHit> shaded);

}  // namespace lambent
