// SPDX-License-Identifier: Apache-2.0
// Scenes that are small against what 32-bit coordinates round to: far from the origin, or tiny.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "lambent/scene.h"

namespace lambent::gltf {

/// Where the origin of what is in a box should be: at the file's, (0, 0, 0), where the box is near
/// enough to that for its size, else at a round number near the middle of the box [m].
glm::dvec3 origin_of(const Bounds& bounds);

/// Whether vertices stand so far from the origin, in their meshes' spaces or in the world, that
/// rounding shows in a scene of this size.
bool is_rounded(const Scene& scene);

/// What to tell people of a scene that was moved, and of one that is so small that its light is
/// wrong; empty where all is well.
std::string warning_of_move(const Bounds& bounds, const glm::dvec3& origin);
std::string warning_of_size(const Bounds& bounds);

}  // namespace lambent::gltf
