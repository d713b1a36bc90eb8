// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// How a mesh is bent out of its stored shape. Empty: not at all.
struct Deformation {
  std::vector<float> morph_weights;        ///< One a morph target; missing ones are 0.
  std::vector<glm::dmat4> joint_matrices;  ///< World from bind pose, one a joint; empty: no skin.

  bool empty() const { return morph_weights.empty() && joint_matrices.empty(); }
};

struct ImportedMesh {
  Mesh mesh;  ///< Mesh::material is the glTF material or -1.
  /// What was subtracted from the vertices of the file [m]: 0 where they are near their origin. Of
  /// a skin it is in the bind pose; joints have brought the mesh to the world.
  glm::dvec3 centre{0.0};
};

/// A primitive as a triangle mesh with unit normals. `recentre`: vertices that are far from the
/// origin of the mesh's space are moved there, before all bending.
/// Tangents are kept or made where `tangent_uv_set` is 0 or 1, and dropped where it is -1. Nothing
/// where the primitive has no triangles (points, lines, all degenerate). Where `rig` is not null,
/// it becomes what bends the mesh in other poses; its mesh, node and skin are left to the caller.
Expected<std::optional<ImportedMesh>> import_primitive(Document& document, int mesh, int primitive,
                                                       const Deformation& deformation,
                                                       bool recentre, int tangent_uv_set,
                                                       RigMesh* rig);

}  // namespace lambent::gltf
