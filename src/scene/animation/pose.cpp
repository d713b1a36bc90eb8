// SPDX-License-Identifier: Apache-2.0
#include "scene/animation/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "scene/limits.h"

namespace lambent {
namespace {

// Scale that replaces a scale of 0: rays miss the mesh, and the inverse is finite.
constexpr float kSpeck = 1e-6f;

// Transforms whose thickness is below this share of their largest extent count as flat: their
// inverse would consist of rounding errors in 32-bit arithmetic.
constexpr double kFlat = 1e-6;
// Thickness that flat transforms get, as a share of their largest extent: it is seldom as large as
// a pixel, and the inverse is accurate to a thousandth.
constexpr double kThickness = 1e-4;

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
  if (!finite(world_from_node) || !is_in_reach(glm::vec3(world_from_node[3]))) return;
  light.position_ws = glm::vec3(world_from_node[3]);
  light.direction_ws = unit_or(-glm::dvec3(world_from_node[2]), light.direction_ws);
}

void place(Camera& camera, const glm::mat4& world_from_node) {
  if (!finite(world_from_node) || !is_in_reach(glm::vec3(world_from_node[3]))) return;
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

float largest_scale(const glm::mat4& m) {
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(glm::dvec3(m[axis]));
    if (!std::isfinite(length)) return std::numeric_limits<float>::infinity();
    largest = std::max(largest, length);
  }
  return static_cast<float>(largest);
}

Bounds mesh_bounds(const Mesh& mesh) {
  Bounds bounds;
  for (const glm::vec3& position : mesh.positions) bounds.add(position);
  return bounds;
}

bool stays_in_reach(const glm::mat4& world_from_object, const Bounds& box) {
  if (box.empty()) return is_in_reach(glm::vec3(world_from_object[3]));
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec4 p((corner & 1) != 0 ? box.max.x : box.min.x,
                      (corner & 2) != 0 ? box.max.y : box.min.y,
                      (corner & 4) != 0 ? box.max.z : box.min.z, 1.0f);
    if (!is_in_reach(glm::vec3(world_from_object * p))) return false;
  }
  return true;
}

std::optional<glm::mat4> drawable(const glm::mat4& world_from_object) {
  const float scale = largest_scale(world_from_object);
  if (!finite(world_from_object) || !(scale >= kMinScale && scale <= kMaxScale)) {
    return std::nullopt;
  }
  // Compute the areas of the images of the unit cube's faces, and the volume of its image
  const glm::dmat3 m = glm::dmat3(world_from_object) / static_cast<double>(scale);
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  const double volume = glm::dot(m[0], cofactors[0]);
  const double area =
      std::sqrt(glm::dot(cofactors[0], cofactors[0]) + glm::dot(cofactors[1], cofactors[1]) +
                glm::dot(cofactors[2], cofactors[2]));
  if (area < kFlat) return std::nullopt;
  if (std::abs(volume) >= kFlat * area) return world_from_object;

  // The cofactors of a flat transform are the outer product of the plane's normal and of the
  // direction that is lost. Adding their multiple gives that direction a thickness along the
  // normal; its sign preserves the handedness
  const glm::dmat3 thickness = cofactors * (std::copysign(kThickness, volume) * scale / area);
  glm::mat4 thickened = world_from_object;
  for (int axis = 0; axis < 3; ++axis) {
    thickened[axis] =
        glm::vec4(glm::vec3(glm::dvec3(world_from_object[axis]) + thickness[axis]), 0);
  }
  return finite(glm::inverse(thickened)) ? std::optional(thickened) : std::nullopt;
}

glm::mat4 drawable_or_speck(const glm::mat4& world_from_object, const Bounds& mesh) {
  if (const auto drawn = drawable(world_from_object); drawn && stays_in_reach(*drawn, mesh)) {
    return *drawn;
  }
  glm::mat4 speck(kSpeck);
  const glm::vec3 place(world_from_object[3]);
  speck[3] = glm::vec4(is_in_reach(place) ? place : glm::vec3(0.0f), 1.0f);
  // The mesh itself may be so large that even the shrunken one would leave the range
  if (!stays_in_reach(speck, mesh)) speck[3] = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  return speck;
}

}  // namespace lambent
