// SPDX-License-Identifier: Apache-2.0
// The properties of a mesh and its material at a point of a triangle: interpolated attributes,
// colour, coverage, emission.
#pragma once

#include "scene/coverage.h"
#include "scene/texture.h"
#include "scene/transmission.h"
#include "shared/color.h"

namespace lambent {

static_assert(kAlphaOpaque == static_cast<uint>(AlphaMode::opaque) &&
              kAlphaMask == static_cast<uint>(AlphaMode::mask) &&
              kAlphaBlend == static_cast<uint>(AlphaMode::blend));

// The types and functions that attributes.inl.h requires.
using InstanceRef = const Instance&;
using MeshRef = const Mesh&;
using MaterialRef = const Material&;
struct TrianglePoint;
using TrianglePointRef = const TrianglePoint&;

inline InstanceRef fetch_instance(const Scene& scene, uint instance) {
  return scene.instances[instance];
}
inline MeshRef fetch_mesh(const Scene& scene, uint mesh) {
  return scene.meshes[mesh];
}
inline MaterialRef fetch_material(const Scene& scene, uint material) {
  return scene.materials[material];
}
inline uvec3 fetch_triangle(const Mesh& mesh, uint triangle) {
  return mesh.triangles[triangle];
}
inline vec3 fetch_position(const Mesh& mesh, uint vertex) {
  return mesh.positions[vertex];
}
inline vec4 fetch_color(const Mesh& mesh, uint vertex) {
  return mesh.colors[vertex];
}
inline bool has_colors(const Mesh& mesh) {
  return !mesh.colors.empty();
}
inline bool has_uvs(const Mesh& mesh, const TextureView& view) {
  return !mesh.uvs[view.uv_set].empty();
}
inline vec2 fetch_uv(const Mesh& mesh, const TextureView& view, uint vertex) {
  return mesh.uvs[view.uv_set][vertex];
}
inline bool is_unlit(const Material& material) {
  return material.unlit;
}
/// Whether some point of the material may emit: emissive, or unlit and not black.
inline bool may_emit(const Material& material) {
  return material.unlit ? vec3(material.base_color) != vec3(0.0f) : material.emission != vec3(0.0f);
}

#include "scene/attributes.inl.h"

}  // namespace lambent
