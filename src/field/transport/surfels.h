// SPDX-License-Identifier: Apache-2.0
// What the probes' rays met. Surfels outlive the update that traced them: light that changes is
// carried again through the same surfels without a ray.
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

/// What a probe ray ended at.
enum class SurfelKind : std::uint8_t {
  surface,    ///< A surface, which may reflect nothing.
  sky,        ///< Nothing: the ray left the scene.
  back_face,  ///< The back of a single-sided surface: the ray does not count.
};

/// What one ray met.
struct Surfel {
  vec3 position_ws;          ///< [m]; of a ray that left the scene, its origin.
  std::uint32_t material;    ///< Index into Scene::materials; 0 where the ray left the scene.
  vec3 albedo_over_pi;       ///< Diffuse and specular together [1/sr]; 0: reflects nothing.
  uint normal_ws;            ///< Packed, towards the probe.
  vec3 light;                ///< Direct irradiance [W/m^2]; of the sky, its radiance [W/(m^2 sr)].
  uint geometric_normal_ws;  ///< Packed, towards the probe.
  SurfelKind kind;
  bool receives_gi;  ///< The field lights it; else it reflects direct light alone.

  bool operator==(const Surfel&) const = default;
  bool reflects() const { return albedo_over_pi != vec3(0.0f); }
};

/// What a surfel reads besides, where volumes blend into each other.
struct FurtherLookup {
  std::uint32_t ray;
  SurfelLookup lookup;
};

/// The rays of one update, and what they weigh in a tile's texels. Probes that trace as many rays
/// in one update share one.
struct RaySet {
  RaySet(const FieldSettings& settings, int rays, uint update_number);

  uint update;                   ///< Number of the update that drew the directions.
  std::vector<vec3> directions;  ///< Unit.
  BlendMatrix irradiance_blend;

  int rays() const { return static_cast<int>(directions.size()); }
};

/// What a probe's rays met when they were last traced.
struct ProbeTrace {
  std::shared_ptr<const RaySet> rays;  ///< Null: never traced.
  std::vector<Surfel> surfels;         ///< One a ray.
  std::vector<SurfelLookup> lookups;   ///< One a ray; undefined where nothing is reflected.
  std::vector<FurtherLookup> further;  ///< Of surfels that read several volumes.

  std::size_t bytes() const;
};

/// Probes that trace the same rays in an update, and what these hit.
struct TraceGroup {
  std::shared_ptr<const RaySet> rays;
  std::vector<int> probes;
  std::vector<Hit> hits;  ///< probes x rays, probe after probe.
};

/// Traces the rays of a group's probes.
void trace_probe_rays(const RayTracer& tracer, const ProbeStore& store, TraceGroup& group);

/// How the hits of a ray set are shaded.
ShadeHitsSettings surfel_shading(const FieldSettings& settings, const RaySet& rays);

/// A probe's ray.
Ray probe_ray(const vec3& origin_ws, const vec3& direction);

/// What a ray met, from its hit.
Surfel make_surfel(const Scene& scene, const Hit& hit, const ShadedHit& shaded);

/// Index of a probe's first ray among all, for its random numbers.
std::size_t first_ray_index(int probe);

/// Turns a group's hits into surfels, all but their lookups. Returns the shadow rays traced.
std::uint64_t shade_surfels(const World& world, const ProbeStore& store, const TraceGroup& group,
                            const FieldSettings& settings, std::span<ProbeTrace> traces);

/// Finds the lookups of the probes' surfels. Returns the rays that their visibility took.
std::uint64_t find_surfel_lookups(const ProbeStore& store, const VisibilityRays& by,
                                  std::span<const int> probes, std::span<ProbeTrace> traces);

/// Those `among` traced probes some of whose surfels may read one of the probes `read`, in the
/// order of `among`.
std::vector<int> probes_reading(std::span<const int> read, std::span<const int> among,
                                const ProbeStore& store, std::span<const ProbeTrace> traces);

}  // namespace lambent
