// SPDX-License-Identifier: Apache-2.0
// A scene as kernels read it: records in arrays, all reachable from one address.
#ifndef LAMBENT_RAYTRACING_VULKAN_SCENE_RECORDS_H
#define LAMBENT_RAYTRACING_VULKAN_SCENE_RECORDS_H

#include "raytracing/ray_records.h"
#include "scene/emissive_sample.h"
#include "scene/light_tree/light_visibility_math.h"
#include "scene/punctual_light.h"
#include "scene/sky/bright_sky.h"

LAMBENT_BEGIN

LAMBENT_DEVICE_ARRAY(Uvec3Array, uvec3, 4)

// TextureViewRecord::sampling: two bits each for the wraps along u and v, then these.
const uint kSamplingWrapBits = 2u;
const uint kSamplingWrapMask = 3u;
const uint kSamplingNearest = 16u;
const uint kSamplingSecondUvs = 32u;

/// How a material reads a texture; see TextureView in scene.h.
struct TextureViewRecord {
  int texture;       ///< Index into the bound textures; -1: none.
  uint sampling;     ///< Wraps and flags, as above.
  vec2 uv_scale;     ///< Multiplies texture coordinates first.
  vec2 uv_rotation;  ///< Cosine and sine.
  vec2 uv_offset;    ///< Added last.
  int width;         ///< Width of the texture [texels].
  int height;        ///< [texels]
  int levels;        ///< Number of its MIP levels.
};

LAMBENT_FN uint wrap_u(TextureViewRecord view) {
  return view.sampling & kSamplingWrapMask;
}
LAMBENT_FN uint wrap_v(TextureViewRecord view) {
  return (view.sampling >> kSamplingWrapBits) & kSamplingWrapMask;
}

// Bits of MaterialRecord::flags
const uint kMaterialDoubleSided = 1u;
const uint kMaterialUnlit = 2u;
const uint kMaterialLambert = 4u;
const uint kMaterialMayEmit = 8u;  ///< Some point of it may emit light.
const uint kMaterialBoundsVolume = 16u;
const uint kMaterialLetsThrough = 32u;  ///< Transmits light; see is_transmissive().
const uint kMaterialHasLayers = 64u;    ///< See has_layers().
const uint kMaterialHasFilm = 128u;     ///< See has_film().

/// See Material in scene.h.
struct MaterialRecord {
  vec4 base_color;
  vec3 emission;  ///< [W/(m^2 sr)]
  float metallic;
  float roughness;
  float normal_scale;
  float ior;
  float specular;
  vec3 specular_color;
  float transmission;
  vec3 absorption;  ///< [1/m]
  float alpha_cutoff;
  uint alpha_mode;  ///< kAlphaOpaque, ...
  uint flags;
  TextureViewRecord base_color_texture;
  TextureViewRecord metallic_roughness_texture;
  TextureViewRecord normal_texture;
  TextureViewRecord emission_texture;
  TextureViewRecord specular_texture;
  TextureViewRecord specular_color_texture;
  TextureViewRecord transmission_texture;
  // Read where the material has layers:
  float clearcoat;
  float clearcoat_roughness;
  float clearcoat_normal_scale;
  float sheen_roughness;
  vec3 sheen_color;
  TextureViewRecord clearcoat_texture;
  TextureViewRecord clearcoat_roughness_texture;
  TextureViewRecord clearcoat_normal_texture;
  TextureViewRecord sheen_color_texture;
  TextureViewRecord sheen_roughness_texture;
  // Read where a film is on it:
  float iridescence;
  float iridescence_ior;
  float iridescence_thickness_min;  ///< [nm]
  float iridescence_thickness_max;  ///< [nm]
  TextureViewRecord iridescence_texture;
  TextureViewRecord iridescence_thickness_texture;
};

// Bits of MeshRecord::attributes: the arrays besides positions, normals and triangles.
const uint kMeshHasTangents = 1u;
const uint kMeshHasColors = 2u;
const uint kMeshHasUvs0 = 4u;
const uint kMeshHasUvs1 = 8u;

/// See Mesh in scene.h. Addresses of absent arrays are 0.
struct MeshRecord {
  Vec3Array positions;  ///< Object space [m].
  Vec3Array normals;
  Vec4Array tangents;
  Vec2Array uvs0;
  Vec2Array uvs1;
  Vec4Array colors;
  Uvec3Array triangles;
  uint material;
  uint attributes;
};

// Bits of InstanceRecord::flags
const uint kInstanceReceivesGi = 1u;
const uint kInstanceCastsGi = 2u;

/// See Instance in scene.h.
struct InstanceRecord {
  mat4 world_from_object;
  uint mesh;
  uint flags;
};

LAMBENT_DEVICE_ARRAY(MaterialArray, MaterialRecord, 4)
LAMBENT_DEVICE_ARRAY(MeshArray, MeshRecord, 8)
LAMBENT_DEVICE_ARRAY(InstanceArray, InstanceRecord, 4)
LAMBENT_DEVICE_ARRAY(LightArray, LightRecord, 4)
LAMBENT_DEVICE_ARRAY(EmitterArray, EmitterRecord, 4)
LAMBENT_DEVICE_ARRAY(LightTreeArray, LightTreeNode, 4)

/// A latitude-longitude map of radiance.
struct EnvironmentMapRecord {
  /// Rows from the top; after them, its coarser levels, and then those of its dim part.
  Vec3Array texels;
  int width;   ///< [texels]; 0: there is none.
  int height;  ///< [texels]
};

/// See Environment in scene.h.
struct EnvironmentRecord {
  EnvironmentMapRecord map;
  BrightSkyCellArray bright_cells;
  vec3 radiance;       ///< [W/(m^2 sr)]; multiplies the map where there is one.
  float rotation;      ///< Rotation of the map about +Y [rad].
  float bright_limit;  ///< See SkyLevels, also for the next.
  float bright_total;
  uint bright_cell_count;  ///< 0: the map has no bright part, nor levels without it.
  uint padding;
};

/// A scene.
struct SceneRecord {
  InstanceArray instances;
  MeshArray meshes;
  MaterialArray materials;
  LightArray lights;
  UintArray asked;  ///< Indices of the lights that every point samples.
  EmitterArray emitters;
  LightTreeArray light_tree;
  LightTreeArray light_groups;   ///< The same tree in groups; see LightGroups.
  UintArray visibility_rows;     ///< See LightVisibility, also for the next two.
  UintArray visibility_weights;  ///< Four weights in each.
  LightVisibilityGrid visibility_grid;
  uint asked_count;
  uint emitter_count;
  uint light_tree_size;
  uint padding;
  EnvironmentRecord environment;
};
LAMBENT_DEVICE_ARRAY(SceneArray, SceneRecord, 8)

LAMBENT_END
#endif
