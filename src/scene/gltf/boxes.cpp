// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/boxes.h"

#include "scene/limits.h"

namespace lambent::gltf {
namespace {

// Columns of a transform whose cosine is larger are sheared.
constexpr float kMaxShear = 1e-3f;

}  // namespace

const char* place_box(const glm::mat4& world_from_node, glm::vec3& centre, glm::vec3& size,
                      glm::mat3& axes) {
  centre = glm::vec3(world_from_node[3]);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::vec3 column(world_from_node[axis]);
    const float scale = glm::length(column);
    if (!(scale > 0.0f)) return "the node is scaled to nothing.";
    axes[axis] = column / scale;
    size[axis] *= scale;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(glm::dot(axes[axis], axes[(axis + 1) % 3])) > kMaxShear) {
      return "the node is sheared.";
    }
  }
  // Mirroring a box changes nothing, and makes its axes a rotation
  if (glm::determinant(axes) < 0.0f) axes[0] = -axes[0];
  return is_in_reach(centre) && is_in_reach(size) ? nullptr
                                                  : "it reaches beyond 1e9 m from the origin.";
}

}  // namespace lambent::gltf
