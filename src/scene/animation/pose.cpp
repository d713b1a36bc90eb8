// SPDX-License-Identifier: Apache-2.0
#include "scene/animation/pose.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace lambent {
namespace {

// Size of what was scaled to nothing: rays miss it, and its inverse is a number.
constexpr float kSpeck = 1e-6f;

// Scaled to unit length in double, where no finite float vector over- or underflows.
glm::vec3 unit_or(const glm::dvec3& v, const glm::vec3& fallback) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

bool finite(const glm::mat4& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  }
  return true;
}

}  // namespace

glm::dmat4 compose_transform(const double* translation, const double* rotation,
                             const double* scale) {
  glm::dmat4 matrix(1.0);
  if (rotation) {
    const glm::dquat q(rotation[3], rotation[0], rotation[1], rotation[2]);
    const double length = glm::length(q);
    if (length > 0.0) matrix = glm::mat4_cast(q / length);
  }
  if (scale) {
    for (int k = 0; k < 3; ++k) matrix[k] *= scale[k];
  }
  if (translation) matrix[3] = glm::dvec4(translation[0], translation[1], translation[2], 1.0);
  return matrix;
}

void place(Light& light, const glm::mat4& world_from_node) {
  if (!finite(world_from_node)) return;
  light.position_ws = glm::vec3(world_from_node[3]);
  light.direction_ws = unit_or(-glm::dvec3(world_from_node[2]), light.direction_ws);
}

void place(Camera& camera, const glm::mat4& world_from_node) {
  if (!finite(world_from_node)) return;
  const glm::vec3 back = unit_or(glm::dvec3(world_from_node[2]), glm::vec3(0.0f, 0.0f, 1.0f));
  const glm::dvec3 up(world_from_node[1]);
  const glm::vec3 any_right =
      std::abs(back.x) < 0.5f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, -1.0f);
  const glm::vec3 fallback = glm::normalize(any_right - back * glm::dot(back, any_right));
  const glm::vec3 right = unit_or(glm::cross(up, glm::dvec3(back)), fallback);
  camera.world_from_view =
      glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::normalize(glm::cross(back, right)), 0.0f),
                glm::vec4(back, 0.0f), glm::vec4(glm::vec3(world_from_node[3]), 1.0f));
}

bool invertible(const glm::mat4& m) {
  return finite(m) && finite(glm::inverse(m));
}

glm::mat4 invertible_or_speck(const glm::mat4& world_from_object) {
  if (invertible(world_from_object)) return world_from_object;
  glm::mat4 speck(kSpeck);
  speck[3] = finite(world_from_object) ? world_from_object[3] : glm::vec4(0, 0, 0, 1);
  return speck;
}

}  // namespace lambent
