// SPDX-License-Identifier: Apache-2.0
// What a mesh and its material say at a point of a triangle: interpolated attributes, colour,
// coverage, emission.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lambent/scene.h"
#include "scene/coverage.h"

namespace lambent {

/// A point of a triangle: its three vertices and their weights, which sum to 1.
struct TrianglePoint {
  glm::uvec3 vertices{0};
  glm::vec3 weights{0.0f};
};

inline TrianglePoint triangle_point(const Mesh& mesh, std::uint32_t triangle,
                                    const glm::vec2& barycentrics) {
  return {mesh.triangles[triangle],
          {1.0f - barycentrics.x - barycentrics.y, barycentrics.x, barycentrics.y}};
}

/// A per-vertex attribute at a point.
template <class T>
T interpolate(const std::vector<T>& attribute, const TrianglePoint& point) {
  return attribute[point.vertices.x] * point.weights.x +
         attribute[point.vertices.y] * point.weights.y +
         attribute[point.vertices.z] * point.weights.z;
}

/// How many squared metres of cone fall on a triangle, as the texture filter wants to know it.
struct TextureFootprint {
  float share_of_triangle =
      0.0f;  ///< Cone's cross section over the triangle's area; 0: full resolution.
};

/// A texture of `mesh` read at a point; white where the view is empty.
glm::vec4 texture_at(const Scene& scene, const Mesh& mesh, const TextureView& view,
                     const TrianglePoint& point, TextureFootprint footprint = {});

/// Whether a footprint covers so much of a texture that what it shows of it is all but its mean.
bool shows_mean_alone(const Scene& scene, const Mesh& mesh, const TextureView& view,
                      const TrianglePoint& point, TextureFootprint footprint);

/// Linear base colour and coverage: factor, texture and vertex colour.
glm::vec4 base_color_at(const Scene& scene, const Mesh& mesh, const Material& material,
                        const TrianglePoint& point, TextureFootprint footprint = {});

/// Emitted radiance [W/(m^2 sr)]; an unlit surface emits its base colour.
glm::vec3 emission_at(const Scene& scene, const Mesh& mesh, const Material& material,
                      const TrianglePoint& point, TextureFootprint footprint = {});

static_assert(kAlphaOpaque == static_cast<uint>(AlphaMode::opaque) &&
              kAlphaMask == static_cast<uint>(AlphaMode::mask) &&
              kAlphaBlend == static_cast<uint>(AlphaMode::blend));

/// Probability that a ray which meets coverage `alpha` is stopped by the material.
inline float stopping_probability(const Material& material, float alpha) {
  return stopping_probability(static_cast<uint>(material.alpha_mode), material.alpha_cutoff, alpha);
}

/// Whether some point of the material may emit: emissive, or unlit and not black.
inline bool may_emit(const Material& material) {
  return material.unlit ? glm::vec3(material.base_color) != glm::vec3(0.0f)
                        : material.emission != glm::vec3(0.0f);
}

}  // namespace lambent
