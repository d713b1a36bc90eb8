// SPDX-License-Identifier: Apache-2.0
// Surfels: the surfaces that probe rays hit. They outlive the update that traced them, so that
// light can be carried through the same surfels again without tracing rays.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/lookup/lookup_volumes.h"
#include "field/lookup/visibility.h"
#include "field/probes/probe_store.h"
#include "field/transport/blend.h"
#include "lambent/field.h"
#include "raytracing/shade_hits.h"

namespace lambent {

/// What a probe ray hit.
enum class SurfelKind : std::uint8_t {
  surface,     ///< A surface, which may reflect nothing.
  sky,         ///< Nothing: the ray left the scene.
  solid_side,  ///< A side that bounds solid matter: the ray came from inside and does not count.
};

/// The hit of one probe ray, shaded; where the ray met mirrors, what they show.
struct Surfel {
  vec3 position_ws;          ///< [m]; the ray's origin where the ray left the scene.
  std::uint32_t material;    ///< Index into Scene::materials; 0 where the ray left the scene.
  vec3 albedo_over_pi;       ///< Diffuse and specular together [1/sr]; 0: reflects nothing.
  uint normal_ws;            ///< Packed, towards the probe.
  vec3 light;                ///< Direct irradiance [W/m^2], or the sky's radiance [W/(m^2 sr)].
  uint geometric_normal_ws;  ///< Packed, towards the probe.
  SurfelKind kind;
  float gi_share;  ///< Share of the field's irradiance that it receives, 0 to 1; see Surface.
  /// Distance along the ray of the first mirror, where a mirror shows the surfel [m]; else 0.
  float mirror_distance;
  uint albedo_shape = 0;  ///< See LitPoint.

  bool operator==(const Surfel&) const = default;
  bool reflects() const { return albedo_over_pi != vec3(0.0f); }
  /// Length of the ray from a probe there to what it hit first [m]; infinite where that is the sky.
  float distance_from(const vec3& origin_ws) const;
  /// The query of the field's light on it, along a ray from a probe there.
  FieldQuery query_from(const vec3& origin_ws, const vec3& ray_direction) const;
};

/// A lookup of a surfel besides its first one, where volumes blend into each other.
struct FurtherLookup {
  std::uint32_t ray;
  SurfelLookup lookup;
};

/// The ray directions of one update, and their weights in a tile's texels. Probes that trace the
/// same number of rays in an update share a ray set.
struct RaySet {
  RaySet(const FieldSettings& settings, int rays, uint update_number);

  uint update;                   ///< Number of the update that drew the directions.
  std::vector<vec3> directions;  ///< Unit.
  BlendMatrix irradiance_blend;

  int rays() const { return static_cast<int>(directions.size()); }
};

/// The surfels of a probe, from the update that traced it last.
struct ProbeTrace {
  std::shared_ptr<const RaySet> rays;  ///< Null where the probe has no surfels.
  std::vector<Surfel> surfels;         ///< One per ray.
  std::vector<SurfelLookup> lookups;  ///< One per ray; undefined where the surfel reflects nothing.
  std::vector<FurtherLookup> further;  ///< Further lookups of surfels that read several volumes.

  std::size_t bytes() const;
};

/// Probes that trace the same ray set in an update, and the hits of their rays.
struct TraceGroup {
  std::shared_ptr<const RaySet> rays;
  std::vector<int> probes;
  std::vector<Hit> hits;  ///< probes x rays, probe after probe.
};

/// Traces the rays of a group's probes.
void trace_probe_rays(const RayTracer& tracer, const ProbeStore& store, TraceGroup& group);

/// The settings with which hits of a ray set are shaded. `solid_sides` may be null, as
/// ShadeHitsSettings says.
ShadeHitsSettings surfel_shading(const FieldSettings& settings, const RaySet& rays,
                                 const SolidSides* solid_sides);

/// The ray of a probe along a direction.
Ray probe_ray(const vec3& origin_ws, const vec3& direction);

/// Makes the surfel of a ray from its shaded hit.
Surfel make_surfel(const ShadedHit& hit);

/// The index of a probe's first ray among the rays of all probes, for its random numbers.
std::size_t first_ray_index(int probe);

/// Makes surfels from a group's hits, without their lookups. Returns the number of shadow rays
/// traced.
std::uint64_t shade_surfels(const World& world, const SolidSides& solid_sides,
                            const ProbeStore& store, const TraceGroup& group,
                            const FieldSettings& settings, std::span<ProbeTrace> traces);

/// Finds the lookups of the probes' surfels. Returns the number of visibility rays traced.
std::uint64_t find_surfel_lookups(const ProbeStore& store, const VisibilityRays& by,
                                  std::span<const int> probes, std::span<ProbeTrace> traces);

/// One flag per surfel of a probe, by ray: 1 for the selected surfels, else 0.
using SurfelFlags = std::vector<std::uint8_t>;

/// Finds the lookups of the flagged surfels only, in a field of one volume. `flagged` has an entry
/// for each of the `probes`. Returns the number of visibility rays traced.
std::uint64_t find_surfel_lookups(const ProbeStore& store, const VisibilityRays& by,
                                  std::span<const int> probes, std::span<const SurfelFlags> flagged,
                                  std::span<ProbeTrace> traces);

/// Flags the surfels of `probes` that may read one of the probes `read`. Surfels that are flagged
/// already stay flagged. An empty entry of `flagged` has no flagged surfels.
void flag_readers(std::span<const int> read, std::span<const int> probes, const ProbeStore& store,
                  std::span<const ProbeTrace> traces, std::span<SurfelFlags> flagged);

/// Returns those of the traced probes `among` whose surfels may read one of the probes `read`, in
/// the order of `among`.
std::vector<int> probes_reading(std::span<const int> read, std::span<const int> among,
                                const ProbeStore& store, std::span<const ProbeTrace> traces);

}  // namespace lambent
