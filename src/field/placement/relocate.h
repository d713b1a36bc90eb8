// SPDX-License-Identifier: Apache-2.0
// Relocation: probes move out of geometry, and to just in front of the surfaces near them, so that
// these surfaces are inside the hull of the probes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/placement/relocate_math.h"
#include "field/probes/probe_store.h"
#include "lambent/scene.h"
#include "raytracing/raytracer.h"
#include "raytracing/solid_sides/solid_sides.h"

namespace lambent {

/// World-space directions of the fixed rays: the same for all probes at all times, so that
/// relocation converges.
std::span<const vec3> fixed_ray_directions();

/// Returns one flag per instance: 1 where it is dynamic.
std::vector<std::uint8_t> moving_instances(const Scene& scene);

/// The static part of a scene, in which fixed rays are traced.
struct StaticScene {
  const Scene& scene;
  const RayTracer& tracer;
  const SolidSides& solid_sides;
  /// One flag per instance: 1 where rays pass through it, because it moves. Instances beyond its
  /// end are static.
  std::span<const std::uint8_t> moving;
};

/// The grids of a store's volumes, as find_solid_sides() takes them.
std::vector<PlaceGrid> place_grids(const ProbeStore& store);

/// A point from which fixed rays are traced, and the axes of the frame in which their hits are
/// returned.
struct Viewpoint {
  vec3 position_ws;
  mat3 axes;
};

/// Traces the fixed rays from some points. `fixed_hits` has one entry per direction, point after
/// point. The rays are traced as one batch, except for those that continue behind moving instances.
void trace_fixed_rays(const StaticScene& stage, std::span<const Viewpoint> viewpoints,
                      std::span<FixedRayHit> fixed_hits);

/// The number of probes whose fixed rays are traced together: few on processors, so that all cores
/// get some.
std::size_t viewpoints_of_batch(const RayTracer& tracer);

/// Whether a point is inside geometry, by the fraction of its fixed rays that hit sides that bound
/// solid matter.
bool inside_geometry(std::span<const FixedRayHit> fixed_hits);

/// A better position for a probe with these hits at `from`, or `from` itself where it should stay.
/// It is at most kMaxProbeOffset of a cell from the probe's place on the grid, `grid_position`. All
/// arguments are in the frame of the hits. `odd` comes from is_odd_probe().
vec3 better_position(std::span<const FixedRayHit> fixed_hits, const vec3& from,
                     const vec3& grid_position, const vec3& spacing, uint odd);

/// Relocates some probes until they have converged. Returns those that moved, in the order of
/// `probes`; their tiles still hold light and distances of their old places. Gives the same bits on
/// any number of threads.
std::vector<int> relocate_probes(const StaticScene& stage, std::span<const int> probes,
                                 ProbeStore& store);

}  // namespace lambent
