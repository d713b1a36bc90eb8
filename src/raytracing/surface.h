// SPDX-License-Identifier: Apache-2.0
// From a hit to what shading needs to know about the surface there.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "lambent/scene.h"
#include "raytracing/raytracer.h"
#include "shared/brdf.h"

namespace lambent {

/// A point of a surface as seen along a ray. Surfaces are two-sided: normals face the ray's origin.
struct Surface {
  glm::vec3 position_ws{0.0f};          ///< On the triangle [m].
  glm::vec3 normal_ws{0.0f};            ///< Shading normal: interpolated, normal-mapped; unit.
  glm::vec3 geometric_normal_ws{0.0f};  ///< Of the triangle; unit.
  Reflectance reflectance{};
  glm::vec3 emission{0.0f};  ///< Radiance [W/(m^2 sr)].
  bool front_face = true;
  bool double_sided = false;
  bool receives_gi = true;  ///< Indirect light reaches it.
};

/// The surface at a hit (not a miss) of `ray`. `footprint` is the width that the ray's cone has
/// there [m] and picks the textures' nearest MIP level, read bilinearly; 0 reads full resolution.
Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint = 0.0f);

/// Has the mesh data of surfaces that will be asked for under way to the caches. Calling it for a
/// batch of hits before surface_at hides most of the wait for memory.
void prefetch_surfaces(const Scene& scene, std::span<const Hit> hits);

/// Coverage (alpha) at a hit, 0 to 1: what decides AlphaMode::mask and AlphaMode::blend.
float coverage_at(const Scene& scene, std::uint32_t instance, std::uint32_t triangle,
                  glm::vec2 barycentrics);

}  // namespace lambent
