// SPDX-License-Identifier: Apache-2.0
#include "raytracing/surface.h"

#include <algorithm>
#include <cmath>

#include "scene/attributes.h"

namespace lambent {
namespace {

// A shading normal turned away from the viewer is bent back to where this cosine is left, so that
// smooth silhouettes and steep normal maps neither go black nor divide by zero.
constexpr float kMinViewCosine = 1e-3f;
// Squared lengths below this are no direction.
constexpr float kMinSquaredLength = 1e-30f;

glm::vec3 normalize_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float squared = glm::dot(v, v);
  return squared > kMinSquaredLength ? v * (1.0f / std::sqrt(squared)) : fallback;
}

// det(M) * inverse(M)^T: takes normals to the world, but for their length and, in mirrored
// instances, their sign, which facing the viewer settles anyway.
glm::mat3 cofactors(const glm::mat4& m) {
  const glm::vec3 x(m[0]), y(m[1]), z(m[2]);
  return {glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)};
}

// Tangent with handedness of the texture coordinates, for meshes that come without tangents.
glm::vec4 tangent_from_uvs(const Mesh& mesh, int uv_set, const TrianglePoint& point) {
  const std::vector<glm::vec2>& uvs = mesh.uvs[uv_set];
  if (uvs.empty()) return glm::vec4(0.0f);
  const glm::vec3 edge1 = mesh.positions[point.vertices.y] - mesh.positions[point.vertices.x];
  const glm::vec3 edge2 = mesh.positions[point.vertices.z] - mesh.positions[point.vertices.x];
  const glm::vec2 uv1 = uvs[point.vertices.y] - uvs[point.vertices.x];
  const glm::vec2 uv2 = uvs[point.vertices.z] - uvs[point.vertices.x];
  const float determinant = uv1.x * uv2.y - uv1.y * uv2.x;
  const float orientation = determinant < 0.0f ? -1.0f : 1.0f;
  // glTF's v runs down the image, its bitangent up: hence the sign of the handedness.
  return {orientation * (edge1 * uv2.y - edge2 * uv1.y), -orientation};
}

// The normal that the map says, in object space.
glm::vec3 mapped_normal(const Scene& scene, const Mesh& mesh, const Material& material,
                        const TrianglePoint& point, TextureFootprint footprint,
                        const glm::vec3& normal) {
  const TextureView& view = material.normal_texture;
  const glm::vec4 tangent = mesh.tangents.empty() ? tangent_from_uvs(mesh, view.uv_set, point)
                                                  : interpolate(mesh.tangents, point);
  const glm::vec3 t = normalize_or(
      glm::vec3(tangent) - normal * glm::dot(normal, glm::vec3(tangent)), glm::vec3(0.0f));
  if (t == glm::vec3(0.0f)) return normal;
  const glm::vec3 b = glm::cross(normal, t) * (tangent.w < 0.0f ? -1.0f : 1.0f);
  glm::vec3 n = glm::vec3(texture_at(scene, mesh, view, point, footprint)) * 2.0f - 1.0f;
  n.x *= material.normal_scale;
  n.y *= material.normal_scale;
  return normalize_or(t * n.x + b * n.y + normal * n.z, normal);
}

// glTF 2.0, Appendix B.3, KHR_materials_ior and KHR_materials_specular, with one Fresnel term for
// both lobes.
Reflectance reflectance_at(const Scene& scene, const Mesh& mesh, const Material& material,
                           const TrianglePoint& point, TextureFootprint footprint) {
  if (material.unlit) return {glm::vec3(0.0f), 1.0f, glm::vec3(0.0f), 0.0f};
  const glm::vec3 base =
      glm::clamp(glm::vec3(base_color_at(scene, mesh, material, point, footprint)), 0.0f, 1.0f);
  float metallic = material.metallic;
  float roughness = material.roughness;
  const bool needs_texel = !material.lambert || metallic > 0.0f;
  if (needs_texel && material.metallic_roughness_texture.texture >= 0) {
    const glm::vec4 texel =
        texture_at(scene, mesh, material.metallic_roughness_texture, point, footprint);
    roughness *= texel.g;
    metallic *= texel.b;
  }
  const glm::vec3 diffuse = base * (1.0f - metallic);
  if (material.lambert) return {diffuse, 1.0f, glm::vec3(0.0f), 0.0f};

  float specular = material.specular;
  if (material.specular_texture.texture >= 0) {
    specular *= texture_at(scene, mesh, material.specular_texture, point, footprint).a;
  }
  glm::vec3 specular_color = material.specular_color;
  if (material.specular_color_texture.texture >= 0) {
    specular_color *=
        glm::vec3(texture_at(scene, mesh, material.specular_color_texture, point, footprint));
  }
  const float root_f0 = (material.ior - 1.0f) / (material.ior + 1.0f);
  const glm::vec3 dielectric_f0 =
      glm::min(specular_color * (root_f0 * root_f0), glm::vec3(1.0f)) * specular;
  return {diffuse, std::max(roughness * roughness, kMinGgxAlpha),
          glm::mix(dielectric_f0, base, metallic), glm::mix(specular, 1.0f, metallic)};
}

}  // namespace

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint) {
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const Material& material = scene.materials[mesh.material];
  const TrianglePoint point = triangle_point(mesh, hit.triangle, hit.barycentrics);
  const glm::mat4& world_from_object = instance.world_from_object;

  // Compute the position and the geometric normal, whose length is twice the triangle's area
  const glm::vec3 p0 = mesh.positions[point.vertices.x];
  const glm::vec3 edge1 = mesh.positions[point.vertices.y] - p0;
  const glm::vec3 edge2 = mesh.positions[point.vertices.z] - p0;
  const glm::vec3 position = p0 + edge1 * point.weights.y + edge2 * point.weights.z;
  const glm::mat3 normal_from_object = cofactors(world_from_object);
  const glm::vec3 face_normal = glm::cross(edge1, edge2);
  const glm::vec3 area_normal = normal_from_object * face_normal;
  const float double_area = glm::length(area_normal);

  Surface surface;
  surface.position_ws = glm::vec3(world_from_object * glm::vec4(position, 1.0f));
  surface.geometric_normal_ws = normalize_or(area_normal, -ray.direction);
  TextureFootprint texture_footprint;
  if (footprint > 0.0f && double_area > 0.0f) {
    texture_footprint.share_of_triangle = 2.0f * footprint * footprint / double_area;
  }

  // Compute the shading normal on the side that the vertices call the front
  glm::vec3 normal = interpolate(mesh.normals, point);
  const bool along_winding = glm::dot(normal, face_normal) >= 0.0f;
  // Bumps that the footprint averages over leave the surface flat
  if (material.normal_texture.texture >= 0 &&
      !shows_mean_alone(scene, mesh, material.normal_texture, point, texture_footprint)) {
    normal = mapped_normal(scene, mesh, material, point, texture_footprint,
                           normalize_or(normal, glm::vec3(0.0f, 0.0f, 1.0f)));
  }
  normal = normalize_or(normal_from_object * normal, surface.geometric_normal_ws);

  // Turn both normals to the side the ray came from
  const bool from_front = glm::dot(surface.geometric_normal_ws, ray.direction) <= 0.0f;
  if (!from_front) surface.geometric_normal_ws = -surface.geometric_normal_ws;
  if (along_winding != from_front) normal = -normal;
  const float view_cosine = -glm::dot(normal, ray.direction);
  if (view_cosine < kMinViewCosine) {
    normal = normalize_or(normal + (view_cosine - kMinViewCosine) * ray.direction,
                          surface.geometric_normal_ws);
  }
  surface.normal_ws = normal;

  surface.reflectance = reflectance_at(scene, mesh, material, point, texture_footprint);
  surface.emission = emission_at(scene, mesh, material, point, texture_footprint);
  surface.front_face = hit.front_face;
  surface.double_sided = material.double_sided;
  surface.receives_gi = instance.receives_gi;
  return surface;
}

void prefetch_surfaces(const Scene& scene, std::span<const Hit> hits) {
  const auto mesh_of = [&](const Hit& hit) -> const Mesh& {
    return scene.meshes[scene.instances[hit.instance].mesh];
  };
  for (const Hit& hit : hits) {
    if (!hit.missed()) __builtin_prefetch(&mesh_of(hit).triangles[hit.triangle]);
  }
  for (const Hit& hit : hits) {
    if (hit.missed()) continue;
    const Mesh& mesh = mesh_of(hit);
    const glm::uvec3& vertices = mesh.triangles[hit.triangle];
    for (int i = 0; i < 3; ++i) {
      __builtin_prefetch(&mesh.positions[vertices[i]]);
      __builtin_prefetch(&mesh.normals[vertices[i]]);
      if (!mesh.uvs[0].empty()) __builtin_prefetch(&mesh.uvs[0][vertices[i]]);
    }
  }
}

float coverage_at(const Scene& scene, std::uint32_t instance, std::uint32_t triangle,
                  glm::vec2 barycentrics) {
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  return base_color_at(scene, mesh, scene.materials[mesh.material],
                       triangle_point(mesh, triangle, barycentrics))
      .a;
}

}  // namespace lambent
