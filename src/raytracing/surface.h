// SPDX-License-Identifier: Apache-2.0
// The surface at a hit, for shading.
#pragma once

#include <span>

#include "lambent/scene.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface_math.h"

namespace lambent {

/// The surface at a hit (not a miss) of `ray`. `footprint`: width of the ray's cone there [m],
/// which selects the nearest texel of one MIP level; 0 reads full resolution, filtered.
Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint = 0.0f);

/// The same for surfaces that pixels show: texels and levels are blended, and where the footprint
/// averages over a normal map, the coat's roughness rises accordingly.
Surface seen_surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint);

/// A point of a triangle.
struct SeenTriangle {
  std::uint32_t instance;
  std::uint32_t triangle;
  glm::vec2 barycentrics;
  bool from_front;
};

/// Share of the light along a straight ray that passes a triangle of a transmissive material.
glm::vec3 straight_share_of(const Scene& scene, const SeenTriangle& seen,
                            const glm::vec3& direction_ws);

/// Whether a triangle of a transmissive material scatters or refracts the light that passes it.
bool bends_light(const Scene& scene, const SeenTriangle& seen);

/// Whether a ray for which crosses_glass() holds passes the triangle.
bool passes_glass_at(const Scene& scene, const SeenTriangle& seen, const Ray& ray);

/// Prefetches the mesh data of surfaces that will be looked up. Calling it for a batch of hits
/// before surface_at hides most of the memory latency.
void prefetch_surfaces(const Scene& scene, std::span<const Hit> hits);

}  // namespace lambent
