// SPDX-License-Identifier: Apache-2.0
// Access to what surface.inl.h requires, on a device: the surface at a hit.
#ifndef LAMBENT_RAYTRACING_SHADERS_SURFACE_AT_GLSL
#define LAMBENT_RAYTRACING_SHADERS_SURFACE_AT_GLSL

#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/surface_math.h"

#define HitRef HitRecord

vec3 fetch_normal(MeshRecord mesh, uint vertex) {
  return mesh.normals.at[vertex];
}
vec4 fetch_tangent(MeshRecord mesh, uint vertex) {
  return mesh.tangents.at[vertex];
}
bool has_tangents(MeshRecord mesh) {
  return (mesh.attributes & kMeshHasTangents) != 0u;
}
bool is_lambert(MaterialRecord material) {
  return (material.flags & kMaterialLambert) != 0u;
}
bool has_film(MaterialRecord material) {
  return (material.flags & kMaterialHasFilm) != 0u;
}
bool is_transmissive(MaterialRecord material) {
  return (material.flags & kMaterialLetsThrough) != 0u;
}
bool bounds_volume(MaterialRecord material) {
  return (material.flags & kMaterialBoundsVolume) != 0u;
}
bool receives_gi(InstanceRecord instance) {
  return (instance.flags & kInstanceReceivesGi) != 0u;
}

#include "raytracing/surface.inl.h"

#endif
