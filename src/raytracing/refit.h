// SPDX-License-Identifier: Apache-2.0
// When a hierarchy that was refitted to moved vertices should be rebuilt.
#pragma once

#include "lambent/scene.h"

namespace lambent {

/// A refitted hierarchy is rebuilt once its box has grown or shrunk by this factor in area: by then
/// its nodes overlap.
inline constexpr float kMaxAreaChange = 1.5f;

/// Half the area of the box around a mesh's vertices [m^2].
inline float half_area(const Mesh& mesh) {
  Bounds bounds;
  for (const glm::vec3& p : mesh.positions) bounds.add(p);
  if (bounds.empty()) return 0.0f;
  const glm::vec3 size = bounds.max - bounds.min;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Whether a hierarchy that was built for a box with this half area should be rebuilt.
inline bool outgrown(float when_built, float now) {
  return now > when_built * kMaxAreaChange || now * kMaxAreaChange < when_built;
}

}  // namespace lambent
