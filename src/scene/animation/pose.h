// SPDX-License-Identifier: Apache-2.0
// Transforms of nodes, applied to lights, cameras and instances.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "lambent/scene.h"

namespace lambent {

/// Translation, rotation and scale as a matrix; each may be null, the rotation (x, y, z, w) need
/// not be unit.
glm::dmat4 compose_transform(const double* translation, const double* rotation,
                             const double* scale);

/// Places a light at a node, pointing along its -Z. The light is not changed where that is out of
/// range (kMaxCoordinate).
void place(Light& light, const glm::mat4& world_from_node);

/// Places a camera at a node, looking along its -Z; scale, shear and mirroring are ignored. The
/// camera is not changed where that is out of range.
void place(Camera& camera, const glm::mat4& world_from_node);

/// Length of the longest of a transform's axes; infinite where one is not finite.
float largest_scale(const glm::mat4& m);

/// Object-space bounds of a mesh's vertices [m].
Bounds mesh_bounds(const Mesh& mesh);

/// Whether a transformed box is within kMaxCoordinate of the origin. For an empty box, this is
/// tested for the origin of its space.
bool stays_in_reach(const glm::mat4& world_from_object, const Bounds& box);

/// A transform with which instances can be rendered. One that flattens them to a plane gets a
/// thickness too small to be seen, so that it has an inverse. None where they become a line or a
/// point, or where the scale is not within kMinScale to kMaxScale.
std::optional<glm::mat4> drawable(const glm::mat4& world_from_object);

/// drawable(), or where there is none or it moves the mesh out of range, a transform that shrinks
/// the mesh to a point too small to be seen.
glm::mat4 drawable_or_speck(const glm::mat4& world_from_object, const Bounds& mesh);

}  // namespace lambent
