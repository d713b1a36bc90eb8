// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// The deformation of a mesh on import. Empty: none.
struct Deformation {
  std::vector<float> morph_weights;        ///< One per morph target; missing ones are 0.
  std::vector<glm::dmat4> joint_matrices;  ///< World from bind pose, one per joint; empty: no skin.

  bool empty() const { return morph_weights.empty() && joint_matrices.empty(); }
};

struct ImportedMesh {
  Mesh mesh;  ///< Mesh::material is the glTF material or -1.
  /// The offset that was subtracted from the file's vertices [m]: 0 where they are near their
  /// origin. With a skin it is in the bind pose, and the mesh is in world space.
  glm::dvec3 centre{0.0};
};

/// Imports a primitive as a triangle mesh with unit normals. `recentre`: vertices that are far from
/// the origin of the mesh's space are moved to it, before any deformation. Tangents are read or
/// computed if `tangent_uv_set` is 0 or 1, and dropped if it is -1. Returns nothing if the
/// primitive has no triangles (points, lines, all degenerate). If `rig` is not null, it is set to
/// the data that deform the mesh in other poses; the caller sets its mesh, node and skin.
Expected<std::optional<ImportedMesh>> import_primitive(Document& document, int mesh, int primitive,
                                                       const Deformation& deformation,
                                                       bool recentre, int tangent_uv_set,
                                                       RigMesh* rig);

}  // namespace lambent::gltf
