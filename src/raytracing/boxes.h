// SPDX-License-Identifier: Apache-2.0
// Boxes, the points in them and the rays that cross them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lambent/scene.h"

namespace lambent {

/// Whether a point is inside a box, off its sides.
inline bool contains(const Bounds& box, const glm::vec3& point) {
  return glm::all(glm::lessThan(box.min, point)) && glm::all(glm::lessThan(point, box.max));
}

/// Whether two boxes share a point.
inline bool overlap(const Bounds& a, const Bounds& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

/// Whether the ray intersects the box between its origin and `t_max`. Kay and Kajiya, SIGGRAPH
/// 1986.
inline bool crosses(const Bounds& box, const glm::vec3& origin, const glm::vec3& direction,
                    float t_max) {
  float enter = 0.0f, leave = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0f) {
      if (origin[axis] < box.min[axis] || origin[axis] > box.max[axis]) return false;
      continue;
    }
    const float inverse = 1.0f / direction[axis];
    const float a = (box.min[axis] - origin[axis]) * inverse;
    const float b = (box.max[axis] - origin[axis]) * inverse;
    enter = glm::max(enter, glm::min(a, b));
    leave = glm::min(leave, glm::max(a, b));
  }
  return enter <= leave;
}

/// A set of boxes, with a box around them all that most rays miss.
class Boxes {
 public:
  void add(const Bounds& box) {
    if (box.empty()) return;
    around_.add(box);
    boxes_.push_back(box);
  }
  bool empty() const { return boxes_.empty(); }

  /// Whether the ray intersects any of them.
  bool crossed_by(const glm::vec3& origin, const glm::vec3& direction, float t_max) const {
    if (boxes_.empty() || !crosses(around_, origin, direction, t_max)) return false;
    for (const Bounds& box : boxes_) {
      if (crosses(box, origin, direction, t_max)) return true;
    }
    return false;
  }

  /// Whether any of them shares a point with a box.
  bool overlapped_by(const Bounds& other) const {
    if (boxes_.empty() || !overlap(around_, other)) return false;
    for (const Bounds& box : boxes_) {
      if (overlap(box, other)) return true;
    }
    return false;
  }

 private:
  std::vector<Bounds> boxes_;
  Bounds around_;
};

}  // namespace lambent
