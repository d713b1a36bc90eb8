// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, sec. 3.7.2.2 "Morph Targets" and 3.7.3 "Skins".
#include "scene/gltf/deform.h"

#include "scene/animation/deform.h"
#include "scene/limits.h"

namespace lambent::gltf {
namespace {

template <class Vector>
Expected<void> displace(const Document& document, const std::map<std::string, int>& target,
                        const char* attribute, const std::string& place, float weight,
                        std::vector<Vector>& vertices) {
  const auto accessor = target.find(attribute);
  if (accessor == target.end() || vertices.empty()) return {};
  LAMBENT_TRY(offsets, read_elements(document, accessor->second, 3));
  if (offsets.size() != vertices.size()) {
    return document.fail_at(place, entry("accessors", accessor->second) + " has " +
                                       std::to_string(offsets.size()) + " elements for " +
                                       std::to_string(vertices.size()) + " vertices");
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) vertices[i][k] += weight * offsets[i][k];
  }
  return {};
}

Expected<void> check_reach(const Document& document, const std::string& place, const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!is_in_reach(mesh.positions[i])) {
      return document.fail_at(
          place, "vertex " + std::to_string(i) + " is moved beyond 1e9 m from the origin");
    }
  }
  return {};
}

}  // namespace

Expected<void> bend_by_morph_targets(const Document& document, const tinygltf::Primitive& primitive,
                                     const std::string& place, const std::vector<float>& weights,
                                     Mesh& mesh) {
  bool bent = false;
  for (std::size_t i = 0; i < primitive.targets.size() && i < weights.size(); ++i) {
    if (weights[i] == 0.0f) continue;
    const std::string target_place = place + "." + entry("targets", i);
    const auto& target = primitive.targets[i];
    LAMBENT_CHECK(displace(document, target, "POSITION", target_place, weights[i], mesh.positions));
    LAMBENT_CHECK(displace(document, target, "NORMAL", target_place, weights[i], mesh.normals));
    LAMBENT_CHECK(displace(document, target, "TANGENT", target_place, weights[i], mesh.tangents));
    bent = true;
  }
  if (!bent) return {};
  return check_reach(document, place, mesh);
}

Expected<void> bend_by_joints(const Document& document, const std::string& place,
                              const std::vector<SkinInfluences>& sets,
                              const std::vector<glm::mat4>& joint_matrices, Mesh& mesh) {
  if (sets.empty()) return document.fail_at(place, "is skinned, but has no JOINTS_0 and WEIGHTS_0");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    // Sum the joints' matrices by weight
    glm::mat4 world_from_bind(0.0f);
    float sum = 0.0f;
    for (const SkinInfluences& set : sets) {
      for (int k = 0; k < 4; ++k) {
        const float weight = set.weights[i][k];
        if (weight == 0.0f) continue;
        const float joint = set.joints[i][k];
        if (!(joint >= 0.0f && joint < static_cast<float>(joint_matrices.size()))) {
          return document.fail_at(
              place + ".attributes",
              "vertex " + std::to_string(i) + " refers to a joint that does not exist");
        }
        world_from_bind += weight * joint_matrices[static_cast<std::size_t>(joint)];
        sum += weight;
      }
    }
    // Vertices without weights follow the first joint: they would collapse to the origin otherwise
    world_from_bind = sum > 0.0f ? world_from_bind / sum : joint_matrices[0];

    const glm::mat3 linear(world_from_bind);
    const glm::mat3 for_normals = normal_matrix(linear);
    mesh.positions[i] = glm::vec3(world_from_bind * glm::vec4(mesh.positions[i], 1.0f));
    if (!mesh.normals.empty()) mesh.normals[i] = for_normals * mesh.normals[i];
    if (!mesh.tangents.empty()) {
      mesh.tangents[i] = glm::vec4(linear * glm::vec3(mesh.tangents[i]), mesh.tangents[i].w);
    }
  }
  return check_reach(document, place, mesh);
}

}  // namespace lambent::gltf
