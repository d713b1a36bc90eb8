// SPDX-License-Identifier: Apache-2.0
// From a hit to what shading needs to know about the surface there: raytracing/surface.h on the
// device.
#ifndef LAMBENT_RAYTRACING_SHADERS_SURFACE_AT_GLSL
#define LAMBENT_RAYTRACING_SHADERS_SURFACE_AT_GLSL

#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/surface_math.h"

/// As struct Surface of surface.h.
struct Surface {
  vec3 position_ws;
  vec3 normal_ws;
  vec3 geometric_normal_ws;
  Reflectance reflectance;
  vec3 emission;
  bool front_face;
  bool double_sided;
  bool receives_gi;
  uint material;
};

/// Tangent with handedness, in object space, that a texture is laid out by.
vec4 tangent_at(MeshRecord mesh, TextureViewRecord view, TrianglePoint p, vec3 edge1, vec3 edge2) {
  if ((mesh.attributes & kMeshHasTangents) != 0u) return interpolate4(mesh.tangents, p);
  CornerUvs uvs = corner_uvs(mesh, view, p);
  if (!uvs.present) return vec4(0.0f);
  return tangent_from_uvs(edge1, edge2, uvs.b - uvs.a, uvs.c - uvs.a);
}

/// The normal that the material's map says, in object space.
vec3 mapped_normal_at(MeshRecord mesh, MaterialRecord material, TrianglePoint p, float cone_share,
                      vec3 normal, vec4 tangent) {
  vec3 t = orthogonal_tangent(normal, vec3(tangent));
  if (t == vec3(0.0f)) return normal;
  return mapped_normal(normal, t, tangent.w,
                       vec3(texture_at(mesh, material.normal_texture, p, cone_share)),
                       material.normal_scale);
}

Reflectance reflectance_at(MeshRecord mesh, MaterialRecord material, TrianglePoint p,
                           float cone_share) {
  if ((material.flags & kMaterialUnlit) != 0u) return lambert_reflectance(vec3(0.0f));
  bool lambert = (material.flags & kMaterialLambert) != 0u;
  vec3 base = clamp(base_color_at(mesh, material, p, cone_share), 0.0f, 1.0f);
  float metallic = material.metallic;
  float roughness = material.roughness;
  if ((!lambert || metallic > 0.0f) && material.metallic_roughness_texture.texture >= 0) {
    vec4 texel = texture_at(mesh, material.metallic_roughness_texture, p, cone_share);
    roughness *= texel.y;
    metallic *= texel.z;
  }
  if (lambert) return lambert_reflectance(base * (1.0f - metallic));

  float specular = material.specular;
  if (material.specular_texture.texture >= 0) {
    specular *= texture_at(mesh, material.specular_texture, p, cone_share).w;
  }
  vec3 specular_color = material.specular_color;
  if (material.specular_color_texture.texture >= 0) {
    specular_color *= vec3(texture_at(mesh, material.specular_color_texture, p, cone_share));
  }
  return coated_reflectance(base, metallic, roughness, specular, specular_color, material.ior);
}

/// The surface at a hit (not a miss). `footprint` is the width that the ray's cone has there [m];
/// 0 reads textures at full resolution.
Surface surface_at(SceneArray scene, RayRecord ray, HitRecord hit, float footprint) {
  InstanceRecord instance = scene.at[0].instances.at[hit.instance];
  MeshRecord mesh = scene.at[0].meshes.at[instance.mesh];
  MaterialRecord material = scene.at[0].materials.at[mesh.material];
  TrianglePoint p = triangle_point(mesh, hit.triangle, hit.barycentrics);

  // Compute the position and the geometric normal, whose length is twice the triangle's area
  vec3 p0 = mesh.positions.at[p.vertices.x];
  vec3 edge1 = mesh.positions.at[p.vertices.y] - p0;
  vec3 edge2 = mesh.positions.at[p.vertices.z] - p0;
  vec3 position = p0 + edge1 * p.weights.y + edge2 * p.weights.z;
  mat3 normal_from_object = cofactors(instance.world_from_object);
  vec3 face_normal = cross(edge1, edge2);
  vec3 area_normal = normal_from_object * face_normal;
  float cone_share = share_of_triangle(footprint, length(area_normal));
  vec3 geometric_normal = normalize_or(area_normal, -ray.direction_ws);

  // Compute the shading normal on the side that the vertices call the front
  vec3 normal = interpolate3(mesh.normals, p);
  bool along_winding = dot(normal, face_normal) >= 0.0f;
  // Bumps that the footprint averages over leave the surface flat
  if (material.normal_texture.texture >= 0 &&
      !shows_mean_alone(mesh, material.normal_texture, p, cone_share)) {
    vec4 tangent = tangent_at(mesh, material.normal_texture, p, edge1, edge2);
    normal = mapped_normal_at(mesh, material, p, cone_share,
                              normalize_or(normal, vec3(0.0f, 0.0f, 1.0f)), tangent);
  }
  normal = normalize_or(normal_from_object * normal, geometric_normal);

  // Turn both normals to the side the ray came from
  bool from_front = dot(geometric_normal, ray.direction_ws) <= 0.0f;
  if (!from_front) geometric_normal = -geometric_normal;
  normal =
      normal_towards_viewer(normal, along_winding, from_front, ray.direction_ws, geometric_normal);
  return Surface(transform_point(instance.world_from_object, position), normal, geometric_normal,
                 reflectance_at(mesh, material, p, cone_share),
                 emission_at(mesh, material, p, cone_share), hit.front_face != 0u,
                 (material.flags & kMaterialDoubleSided) != 0u,
                 (instance.flags & kInstanceReceivesGi) != 0u, mesh.material);
}

#endif
