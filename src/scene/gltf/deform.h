// SPDX-License-Identifier: Apache-2.0
// Applies morph targets and skins to vertices on import.
#pragma once

#include <glm/glm.hpp>

#include "lambent/scene.h"
#include "scene/gltf/document/accessors.h"

namespace lambent::gltf {

/// One set of four joints and their weights per vertex.
struct SkinInfluences {
  Elements joints;
  Elements weights;
};

/// Adds the weighted displacements of a primitive's morph targets to positions, normals and
/// tangents.
Expected<void> bend_by_morph_targets(const Document& document, const tinygltf::Primitive& primitive,
                                     const std::string& place, const std::vector<float>& weights,
                                     Mesh& mesh);

/// Moves each vertex by the weighted sum of its joints' matrices. Weights are scaled to a sum of 1.
Expected<void> bend_by_joints(const Document& document, const std::string& place,
                              const std::vector<SkinInfluences>& sets,
                              const std::vector<glm::mat4>& joint_matrices, Mesh& mesh);

}  // namespace lambent::gltf
