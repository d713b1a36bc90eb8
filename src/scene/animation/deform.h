// SPDX-License-Identifier: Apache-2.0
// Meshes that follow morph weights and joints.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "lambent/scene.h"

namespace lambent {

/// What turns normals where `m` turns points: the inverse transpose, but for a positive factor.
/// Unlike the inverse, it exists for every matrix.
glm::mat3 normal_matrix(const glm::mat3& m);

/// Bends a mesh of the scene: first by morph weights (missing ones are 0), then by its joints'
/// transforms from bind pose to world (none: not at all). Raises its revision if a vertex moved. It
/// stays as it was where it would leave the range of coordinates (kMaxCoordinate), itself or in
/// one of `instances`, those of the mesh.
void bend(Scene& scene, const RigMesh& rig, std::span<const float> morph_weights,
          std::span<const glm::mat4> world_from_bind, std::span<const int> instances);

}  // namespace lambent
