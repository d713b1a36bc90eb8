// SPDX-License-Identifier: Apache-2.0
#include "raytracing/surface.h"

#include <algorithm>
#include <cmath>

#include "raytracing/surface_math.h"
#include "scene/attributes.h"

namespace lambent {
namespace {

// Tangent with handedness, in object space, that a texture is laid out by.
glm::vec4 tangent_at(const Mesh& mesh, int uv_set, const TrianglePoint& point) {
  if (!mesh.tangents.empty()) return interpolate(mesh.tangents, point);
  const std::vector<glm::vec2>& uvs = mesh.uvs[uv_set];
  if (uvs.empty()) return glm::vec4(0.0f);
  const glm::uvec3& v = point.vertices;
  return tangent_from_uvs(mesh.positions[v.y] - mesh.positions[v.x],
                          mesh.positions[v.z] - mesh.positions[v.x], uvs[v.y] - uvs[v.x],
                          uvs[v.z] - uvs[v.x]);
}

// The normal that the map says, in object space.
glm::vec3 mapped_normal_at(const Scene& scene, const Mesh& mesh, const Material& material,
                           const TrianglePoint& point, TextureFootprint footprint,
                           const glm::vec3& normal) {
  const TextureView& view = material.normal_texture;
  const glm::vec4 tangent = tangent_at(mesh, view.uv_set, point);
  const glm::vec3 t = orthogonal_tangent(normal, glm::vec3(tangent));
  if (t == glm::vec3(0.0f)) return normal;
  return mapped_normal(normal, t, tangent.w,
                       glm::vec3(texture_at(scene, mesh, view, point, footprint)),
                       material.normal_scale);
}

Reflectance reflectance_at(const Scene& scene, const Mesh& mesh, const Material& material,
                           const TrianglePoint& point, TextureFootprint footprint) {
  if (material.unlit) return lambert_reflectance(glm::vec3(0.0f));
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
  if (material.lambert) return lambert_reflectance(base * (1.0f - metallic));

  float specular = material.specular;
  if (material.specular_texture.texture >= 0) {
    specular *= texture_at(scene, mesh, material.specular_texture, point, footprint).a;
  }
  glm::vec3 specular_color = material.specular_color;
  if (material.specular_color_texture.texture >= 0) {
    specular_color *=
        glm::vec3(texture_at(scene, mesh, material.specular_color_texture, point, footprint));
  }
  return coated_reflectance(base, metallic, roughness, specular, specular_color, material.ior);
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
  surface.position_ws = transform_point(world_from_object, position);
  surface.geometric_normal_ws = normalize_or(area_normal, -ray.direction);
  const TextureFootprint texture_footprint{share_of_triangle(footprint, double_area)};

  // Compute the shading normal on the side that the vertices call the front
  glm::vec3 normal = interpolate(mesh.normals, point);
  const bool along_winding = glm::dot(normal, face_normal) >= 0.0f;
  // Bumps that the footprint averages over leave the surface flat
  if (material.normal_texture.texture >= 0 &&
      !shows_mean_alone(scene, mesh, material.normal_texture, point, texture_footprint)) {
    normal = mapped_normal_at(scene, mesh, material, point, texture_footprint,
                              normalize_or(normal, glm::vec3(0.0f, 0.0f, 1.0f)));
  }
  normal = normalize_or(normal_from_object * normal, surface.geometric_normal_ws);

  // Turn both normals to the side the ray came from
  const bool from_front = glm::dot(surface.geometric_normal_ws, ray.direction) <= 0.0f;
  if (!from_front) surface.geometric_normal_ws = -surface.geometric_normal_ws;
  surface.normal_ws = normal_towards_viewer(normal, along_winding, from_front, ray.direction,
                                            surface.geometric_normal_ws);

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
