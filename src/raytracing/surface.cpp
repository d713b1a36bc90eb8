// SPDX-License-Identifier: Apache-2.0
#include "raytracing/surface.h"

#include "scene/attributes.h"

namespace lambent {
namespace {

// What surface.inl.h requires of its includer.
using HitRef = const Hit&;

vec3 fetch_normal(const Mesh& mesh, uint vertex) {
  return mesh.normals[vertex];
}
vec4 fetch_tangent(const Mesh& mesh, uint vertex) {
  return mesh.tangents[vertex];
}
bool has_tangents(const Mesh& mesh) {
  return !mesh.tangents.empty();
}
bool is_lambert(const Material& material) {
  return material.lambert;
}
bool receives_gi(const Instance& instance) {
  return instance.receives_gi;
}
bool bounds_volume(const Material& material) {
  return material.bounds_volume;
}

#include "raytracing/surface.inl.h"

/// surface_at() as one function: its formulas pass large records by value.
__attribute__((flatten)) Surface inlined_surface_at(const Scene& scene, const vec3& direction_ws,
                                                    const Hit& hit, const Footprint& footprint) {
  return surface_at(scene, direction_ws, hit, footprint);
}

}  // namespace

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint) {
  return inlined_surface_at(scene, ray.direction, hit, Footprint{footprint, 0u});
}

Surface seen_surface_at(const Scene& scene, const Ray& ray, const Hit& hit, float footprint) {
  return inlined_surface_at(scene, ray.direction, hit, Footprint{footprint, 1u});
}

vec3 straight_share_of(const Scene& scene, const SeenTriangle& seen, const vec3& direction_ws) {
  return straight_share_at(scene, seen.instance, seen.triangle, seen.barycentrics, seen.from_front,
                           direction_ws);
}

bool bends_light(const Scene& scene, const SeenTriangle& seen) {
  return bends_light_at(scene, seen.instance, seen.triangle, seen.barycentrics);
}

bool passes_glass_at(const Scene& scene, const SeenTriangle& seen, const Ray& ray) {
  const vec3 share = straight_share_of(scene, seen, ray.direction);
  return passes_glass(share, seen.triangle, ray.origin, ray.direction);
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

}  // namespace lambent
