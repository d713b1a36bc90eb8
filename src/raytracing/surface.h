// SPDX-License-Identifier: Apache-2.0
// From a hit to what shading needs to know about the surface there.
#pragma once

#include <span>

#include "lambent/scene.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface_math.h"

namespace lambent {

/// The surface at a hit (not a miss) of `ray`. `footprint` is the width that the ray's cone has
/// there [m] and picks the nearest texel of one MIP level; 0 reads full resolution, filtered.
Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint = 0.0f);

/// The same for rays whose surfaces are looked at: texels and levels are blended, and where the
/// footprint averages over a normal map, the coat is as much rougher.
Surface seen_surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint);

/// A point of a triangle.
struct SeenTriangle {
  std::uint32_t instance;
  std::uint32_t triangle;
  glm::vec2 barycentrics;
  bool from_front;
};

/// Share of the light along a straight ray that passes a triangle whose material lets light
/// through.
glm::vec3 straight_share_of(const Scene& scene, const SeenTriangle& seen,
                            const glm::vec3& direction_ws);

/// Whether a ray that crosses glass passes it.
bool passes_glass_at(const Scene& scene, const SeenTriangle& seen, const Ray& ray);

/// Has the mesh data of surfaces that will be asked for under way to the caches. Calling it for a
/// batch of hits before surface_at hides most of the wait for memory.
void prefetch_surfaces(const Scene& scene, std::span<const Hit> hits);

}  // namespace lambent
