// SPDX-License-Identifier: Apache-2.0
// Where probes stand off the grid: out of solid matter, and just in front of the surfaces near
// them, so that these are lit from within the probes' hull.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/placement/relocate_math.h"
#include "field/probes/probe_store.h"
#include "lambent/scene.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// World-space directions a probe looks in: the same for all probes at all times, so that probes
/// come to rest.
std::span<const vec3> fixed_ray_directions();

/// One flag an instance: it moves.
std::vector<std::uint8_t> moving_instances(const Scene& scene);

/// From where to look around, and the axes of the frame that sights are told in.
struct Viewpoint {
  vec3 position_ws;
  mat3 axes;
};

/// Looks around from some points. `moving` holds one flag an instance: the ray looks through those
/// that move; instances beyond its end keep still. `sights` has one entry a direction, point after
/// point. One batch of rays, but for those that meet what moves.
void trace_fixed_rays(const Scene& scene, const RayTracer& tracer,
                      std::span<const Viewpoint> viewpoints, std::span<const std::uint8_t> moving,
                      std::span<FixedRayHit> fixed_hits);

/// How many probes to look around from at once: on processors few, so that all cores have some.
std::size_t viewpoints_of_batch(const RayTracer& tracer);

/// True where so many sights met back faces that the point must be in solid matter.
bool inside_geometry(std::span<const FixedRayHit> fixed_hits);

/// Where a probe that belongs at `home` and sees this from `from` had better stand; `from` itself
/// where it may stay. At most kMaxProbeOffset of a cell from home. All in the sights' frame.
vec3 better_position(std::span<const FixedRayHit> fixed_hits, const vec3& from, const vec3& home,
                     const vec3& spacing);

/// Moves some probes until they stand well, then leaves them. Returns those that moved, in the
/// order of `probes`: what they hold is of another place. The same bits on any number of threads.
std::vector<int> relocate_probes(const Scene& scene, const RayTracer& tracer,
                                 std::span<const int> probes, std::span<const std::uint8_t> moving,
                                 ProbeStore& store);

}  // namespace lambent
