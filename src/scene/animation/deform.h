// SPDX-License-Identifier: Apache-2.0
// Deformation of meshes by morph weights and joints.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "lambent/scene.h"

namespace lambent {

/// The matrix that transforms normals where `m` transforms points: the inverse transpose up to a
/// positive factor. Unlike the inverse, it exists for every matrix.
glm::mat3 normal_matrix(const glm::mat3& m);

/// Deforms a mesh of the scene: first by morph weights (missing ones are 0), then by its joints'
/// transforms from bind pose to world (empty: no skinning). Raises its revision if a vertex moved.
/// The mesh is not changed if it, or one of its `instances`, would leave the range of coordinates
/// (kMaxCoordinate).
void deform_mesh(Scene& scene, const RigMesh& rig, std::span<const float> morph_weights,
                 std::span<const glm::mat4> world_from_bind, std::span<const int> instances);

}  // namespace lambent
