// SPDX-License-Identifier: Apache-2.0
// What the probes' rays met. Surfels outlive the update that traced them: light that changes is
// carried again through the same surfels without a ray.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/lookup_cpu.h"
#include "field/probe_store.h"
#include "lambent/field.h"
#include "raytracing/shade_hits.h"

namespace lambent {

/// How a surfel reads the field: the shares of the eight probes around it, and, within each of
/// their tiles, the four texels around its normal (a place in the tile's interior grid, counted
/// with gutter).
struct SurfelLookup {
  CornerWeights corners;
  std::uint32_t tile_corner;  ///< x + (texels + 1) * y of the fetch's first texel.
  float fraction_x, fraction_y;
};

/// One entry a ray, probe after probe: surfel = probe * rays_per_probe + ray.
struct Surfels {
  int rays_per_probe = 0;
  std::vector<vec3> position_ws;     ///< [m]
  std::vector<vec3> normal_ws;       ///< Unit, towards the probe.
  std::vector<vec3> albedo_over_pi;  ///< Diffuse and specular together [1/sr]; 0: no surface.
  std::vector<uint>
      emission;  ///< RGB9E5 radiance. Reaches others as direct light, not through probes.
  std::vector<vec3> direct_irradiance;  ///< From lights and emissive surfaces [W/m^2].
  std::vector<vec3> sky_radiance;       ///< Of rays that left the scene [W/(m^2 sr)], else 0.
  std::vector<std::uint8_t> counts;     ///< 0: the ray met the back of a single-sided surface.
  std::vector<SurfelLookup> lookups;    ///< Undefined where albedo is 0.

  std::size_t size() const { return counts.size(); }
  std::size_t bytes() const;
  void resize(std::size_t probes, int rays);
  /// Sets all of a surfel but its lookup.
  void set(std::size_t surfel, const ShadedHit& hit);
};

/// Traces every probe's rays. `hits` has probes x directions entries, probe after probe.
void trace_probe_rays(const RayTracer& tracer, const ProbeGrid& grid,
                      std::span<const vec3> directions, std::vector<Hit>& hits);

/// How the hits of an update's rays are shaded.
ShadeHitsSettings surfel_shading(const FieldSettings& settings, uint update);

/// Fills surfels (all but their lookups) from hits. Returns the shadow rays traced.
std::uint64_t shade_surfels(const World& world, const ProbeGrid& grid,
                            std::span<const vec3> directions, std::span<const Hit> hits,
                            const FieldSettings& settings, uint update, Surfels& surfels);

/// Fills the surfels' lookups from the stored distances.
void find_surfel_lookups(const ProbeStore& store, std::span<const vec3> directions,
                         Surfels& surfels);

}  // namespace lambent
