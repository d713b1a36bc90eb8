// SPDX-License-Identifier: Apache-2.0
// Access to a scene in a device's memory, as texture.inl.h and attributes.inl.h require it.
// Includes the scene's textures, which must be bound.
#ifndef LAMBENT_RAYTRACING_SHADERS_SCENE_FETCH_GLSL
#define LAMBENT_RAYTRACING_SHADERS_SCENE_FETCH_GLSL

#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_samplerless_texture_functions : require

#include "raytracing/vulkan/scene_records.h"
#include "scene/coverage.h"
#include "scene/mip_level.h"
#include "scene/texture_lookup.h"

// One sampler for each pair of wraps: wrap of u + 3 * wrap of v. All are bilinear.
const uint kWraps = 3u;
layout(set = 0, binding = 0) uniform texture2D scene_textures[];
layout(set = 0, binding = 1) uniform sampler scene_samplers[kWraps * kWraps];

/// A MIP level of a bound texture.
struct LevelOfTexture {
  int texture;
  int level;
  int width;
  int height;
};

#define SceneRef SceneArray
#define InstanceRef InstanceRecord
#define MeshRef MeshRecord
#define MaterialRef MaterialRecord
#define TrianglePointRef TrianglePoint
#define TextureViewRef TextureViewRecord
#define TextureLevelRef LevelOfTexture

bool is_nearest(TextureViewRecord view) {
  return (view.sampling & kSamplingNearest) != 0u;
}
vec2 uv_rotation(TextureViewRecord view) {
  return view.uv_rotation;
}
int level_count(SceneArray scene, TextureViewRecord view) {
  return view.levels;
}
LevelOfTexture fetch_level(SceneArray scene, TextureViewRecord view, int level) {
  return LevelOfTexture(view.texture, level, max(view.width >> level, 1),
                        max(view.height >> level, 1));
}
vec4 fetch_texel(LevelOfTexture level, int x, int y) {
  return texelFetch(scene_textures[nonuniformEXT(level.texture)], ivec2(x, y), level.level);
}

#include "scene/texture.inl.h"

InstanceRecord fetch_instance(SceneArray scene, uint instance) {
  return scene.at[0].instances.at[instance];
}
MeshRecord fetch_mesh(SceneArray scene, uint mesh) {
  return scene.at[0].meshes.at[mesh];
}
MaterialRecord fetch_material(SceneArray scene, uint material) {
  return scene.at[0].materials.at[material];
}
uvec3 fetch_triangle(MeshRecord mesh, uint triangle) {
  return mesh.triangles.at[triangle];
}
vec3 fetch_position(MeshRecord mesh, uint vertex) {
  return mesh.positions.at[vertex];
}
vec4 fetch_color(MeshRecord mesh, uint vertex) {
  return mesh.colors.at[vertex];
}
bool has_colors(MeshRecord mesh) {
  return (mesh.attributes & kMeshHasColors) != 0u;
}
bool reads_second_uvs(TextureViewRecord view) {
  return (view.sampling & kSamplingSecondUvs) != 0u;
}
bool has_uvs(MeshRecord mesh, TextureViewRecord view) {
  return (mesh.attributes & (reads_second_uvs(view) ? kMeshHasUvs1 : kMeshHasUvs0)) != 0u;
}
vec2 fetch_uv(MeshRecord mesh, TextureViewRecord view, uint vertex) {
  return reads_second_uvs(view) ? mesh.uvs1.at[vertex] : mesh.uvs0.at[vertex];
}
bool is_unlit(MaterialRecord material) {
  return (material.flags & kMaterialUnlit) != 0u;
}
bool has_layers(MaterialRecord material) {
  return (material.flags & kMaterialHasLayers) != 0u;
}
bool may_emit(MaterialRecord material) {
  return (material.flags & kMaterialMayEmit) != 0u;
}
/// Filtered by the device, whose weights are coarse.
vec4 sample_texture(SceneArray scene, TextureViewRecord view, vec2 uv, float level) {
  if (is_nearest(view)) return nearest_texel(scene, view, uv, int(level + 0.5f));
  uint wraps = wrap_u(view) + kWraps * wrap_v(view);
  float finer = floor(level);
  return textureLod(nonuniformEXT(sampler2D(scene_textures[nonuniformEXT(view.texture)],
                                            scene_samplers[nonuniformEXT(wraps)])),
                    wrap_uv(view, uv), finer + level_share(level - finer));
}

#include "scene/attributes.inl.h"

#endif
