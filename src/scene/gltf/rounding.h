// SPDX-License-Identifier: Apache-2.0
// Scenes whose size is small compared to the rounding of 32-bit coordinates: far from the origin,
// or tiny.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "lambent/scene.h"

namespace lambent::gltf {

/// The best origin for the contents of a box [m]: the file's, (0, 0, 0), if the box is near enough
/// to it for its size, else a round number near the centre of the box.
glm::dvec3 origin_of(const Bounds& bounds);

/// Whether vertices are so far from the origin, in their meshes' spaces or in the world, that
/// rounding is visible in a scene of this size.
bool is_rounded(const Scene& scene);

/// Warnings for a scene that was moved, and for one that is so small that its light is wrong; empty
/// if there is no problem.
std::string warning_of_move(const Bounds& bounds, const glm::dvec3& origin);
std::string warning_of_size(const Bounds& bounds);

}  // namespace lambent::gltf
