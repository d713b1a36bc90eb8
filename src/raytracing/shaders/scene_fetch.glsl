// SPDX-License-Identifier: Apache-2.0
// What the scene's meshes, materials and textures say at a point of a triangle: scene/attributes.h
// on the device. Includes the scene's textures, which must be bound.
#ifndef LAMBENT_RAYTRACING_SHADERS_SCENE_FETCH_GLSL
#define LAMBENT_RAYTRACING_SHADERS_SCENE_FETCH_GLSL

#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_samplerless_texture_functions : require

#include "raytracing/vulkan/scene_records.h"
#include "scene/coverage.h"
#include "scene/texture_lookup.h"

// One sampler a pair of wraps: wrap of u + 3 * wrap of v. All are bilinear.
const uint kWraps = 3u;
layout(set = 0, binding = 0) uniform texture2D scene_textures[];
layout(set = 0, binding = 1) uniform sampler scene_samplers[kWraps * kWraps];

/// A point of a triangle: its three vertices and their weights, which sum to 1.
struct TrianglePoint {
  uvec3 vertices;
  vec3 weights;
};

TrianglePoint triangle_point(MeshRecord mesh, uint triangle, vec2 barycentrics) {
  vec3 weights = vec3(1.0f - barycentrics.x - barycentrics.y, barycentrics.x, barycentrics.y);
  return TrianglePoint(mesh.triangles.at[triangle], weights);
}

vec3 interpolate3(Vec3Array values, TrianglePoint p) {
  return values.at[p.vertices.x] * p.weights.x + values.at[p.vertices.y] * p.weights.y +
         values.at[p.vertices.z] * p.weights.z;
}

vec4 interpolate4(Vec4Array values, TrianglePoint p) {
  return values.at[p.vertices.x] * p.weights.x + values.at[p.vertices.y] * p.weights.y +
         values.at[p.vertices.z] * p.weights.z;
}

/// Texture coordinates of a triangle's corners.
struct CornerUvs {
  bool present;
  vec2 a, b, c;
};

CornerUvs corner_uvs(MeshRecord mesh, TextureViewRecord view, TrianglePoint p) {
  bool second = (view.sampling & kSamplingSecondUvs) != 0u;
  if ((mesh.attributes & (second ? kMeshHasUvs1 : kMeshHasUvs0)) == 0u) {
    return CornerUvs(false, vec2(0.0f), vec2(0.0f), vec2(0.0f));
  }
  Vec2Array uvs = mesh.uvs0;
  if (second) uvs = mesh.uvs1;
  return CornerUvs(true, uvs.at[p.vertices.x], uvs.at[p.vertices.y], uvs.at[p.vertices.z]);
}

vec2 interpolate_uvs(CornerUvs uvs, TrianglePoint p) {
  return uvs.a * p.weights.x + uvs.b * p.weights.y + uvs.c * p.weights.z;
}

vec2 wrap_uv(TextureViewRecord view, vec2 uv) {
  vec2 transformed = transform_uv(uv, view.uv_scale, view.uv_rotation, view.uv_offset);
  return vec2(wrap_coordinate(transformed.x, wrap_u(view)),
              wrap_coordinate(transformed.y, wrap_v(view)));
}

vec4 fetch_texel(TextureViewRecord view, int x, int y, int level) {
  return texelFetch(scene_textures[nonuniformEXT(view.texture)], ivec2(x, y), level);
}

/// The one texel of a MIP level (clamped to what exists) at texture coordinates.
vec4 nearest_texel(TextureViewRecord view, vec2 uv, int wanted_level) {
  int level = clamp(wanted_level, 0, view.levels - 1);
  vec2 wrapped = wrap_uv(view, uv);
  int x = nearest_index(wrapped.x, max(view.width >> level, 1), wrap_u(view));
  int y = nearest_index(wrapped.y, max(view.height >> level, 1), wrap_v(view));
  return fetch_texel(view, x, y, level);
}

/// Full resolution, as the view says: nearest, or bilinear by the device's filter, whose weights
/// are coarse.
vec4 filtered_texel(TextureViewRecord view, vec2 uv) {
  if ((view.sampling & kSamplingNearest) != 0u) return nearest_texel(view, uv, 0);
  uint wraps = wrap_u(view) + kWraps * wrap_v(view);
  return textureLod(nonuniformEXT(sampler2D(scene_textures[nonuniformEXT(view.texture)],
                                            scene_samplers[nonuniformEXT(wraps)])),
                    wrap_uv(view, uv), 0.0f);
}

/// Alpha at full resolution, as the host reads it: decisions hang on it.
float exact_alpha(TextureViewRecord view, vec2 uv) {
  if ((view.sampling & kSamplingNearest) != 0u) return nearest_texel(view, uv, 0).a;
  vec2 wrapped = wrap_uv(view, uv);
  TexelPair x = texels_around(wrapped.x, view.width, wrap_u(view));
  TexelPair y = texels_around(wrapped.y, view.height, wrap_v(view));
  return ((1.0f - x.fraction) * (1.0f - y.fraction)) * fetch_texel(view, x.first, y.first, 0).a +
         (x.fraction * (1.0f - y.fraction)) * fetch_texel(view, x.second, y.first, 0).a +
         ((1.0f - x.fraction) * y.fraction) * fetch_texel(view, x.first, y.second, 0).a +
         (x.fraction * y.fraction) * fetch_texel(view, x.second, y.second, 0).a;
}

int mip_level(TextureViewRecord view, CornerUvs uvs, float cone_share) {
  return mip_level(uvs.b - uvs.a, uvs.c - uvs.a, view.uv_scale, view.width, view.height,
                   cone_share);
}

/// A texture of a mesh at a point; white where the view is empty. `cone_share`: the cone's cross
/// section over the triangle's area; 0: full resolution.
vec4 texture_at(MeshRecord mesh, TextureViewRecord view, TrianglePoint p, float cone_share) {
  if (view.texture < 0) return vec4(1.0f);
  CornerUvs uvs = corner_uvs(mesh, view, p);
  if (!uvs.present) return filtered_texel(view, vec2(0.0f));
  vec2 uv = interpolate_uvs(uvs, p);
  if (cone_share <= 0.0f) return filtered_texel(view, uv);
  return nearest_texel(view, uv, mip_level(view, uvs, cone_share));
}

/// Whether a footprint covers so much of a texture that what it shows of it is all but its mean.
bool shows_mean_alone(MeshRecord mesh, TextureViewRecord view, TrianglePoint p, float cone_share) {
  CornerUvs uvs = corner_uvs(mesh, view, p);
  if (!uvs.present || cone_share <= 0.0f) return false;
  return shows_mean_alone(mip_level(view, uvs, cone_share), view.levels - 1);
}

vec3 base_color_at(MeshRecord mesh, MaterialRecord material, TrianglePoint p, float cone_share) {
  vec3 color = vec3(material.base_color);
  if (material.base_color_texture.texture >= 0) {
    color *= vec3(texture_at(mesh, material.base_color_texture, p, cone_share));
  }
  if ((mesh.attributes & kMeshHasColors) != 0u) color *= vec3(interpolate4(mesh.colors, p));
  return color;
}

/// Emitted radiance [W/(m^2 sr)]; an unlit surface emits its base colour.
vec3 emission_at(MeshRecord mesh, MaterialRecord material, TrianglePoint p, float cone_share) {
  if ((material.flags & kMaterialMayEmit) == 0u) return vec3(0.0f);
  if ((material.flags & kMaterialUnlit) != 0u) return base_color_at(mesh, material, p, cone_share);
  vec3 emission = material.emission;
  if (material.emission_texture.texture >= 0) {
    emission *= vec3(texture_at(mesh, material.emission_texture, p, cone_share));
  }
  return emission;
}

/// Coverage, 0 to 1: what decides kAlphaMask and kAlphaBlend.
float coverage_at(MeshRecord mesh, MaterialRecord material, TrianglePoint p) {
  float alpha = material.base_color.a;
  if (material.base_color_texture.texture >= 0) {
    CornerUvs uvs = corner_uvs(mesh, material.base_color_texture, p);
    alpha *= exact_alpha(material.base_color_texture, interpolate_uvs(uvs, p));
  }
  if ((mesh.attributes & kMeshHasColors) != 0u) alpha *= interpolate4(mesh.colors, p).a;
  return alpha;
}

/// Whether a triangle stops the ray that meets it there: for any-hit shaders.
bool stops_ray_at(SceneArray scene, uint instance, uint triangle, vec2 barycentrics,
                  float distance) {
  MeshRecord mesh = scene.at[0].meshes.at[scene.at[0].instances.at[instance].mesh];
  MaterialRecord material = scene.at[0].materials.at[mesh.material];
  float alpha = coverage_at(mesh, material, triangle_point(mesh, triangle, barycentrics));
  return stops_ray(material.alpha_mode, material.alpha_cutoff, alpha, barycentrics, distance,
                   triangle);
}

#endif
