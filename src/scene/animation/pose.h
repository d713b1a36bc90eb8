// SPDX-License-Identifier: Apache-2.0
// What the transform of a node does to that which stands there.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "lambent/scene.h"

namespace lambent {

/// Translation, rotation and scale as a matrix; each may be null, the rotation (x, y, z, w) need
/// not be unit.
glm::dmat4 compose_transform(const double* translation, const double* rotation,
                             const double* scale);

/// Puts a light where the node is, shining along its -Z; nothing where that is out of reach
/// (kMaxCoordinate).
void place(Light& light, const glm::mat4& world_from_node);

/// Puts a camera where the node is, looking along its -Z; scale, shear and mirroring do not bend
/// it. Nothing where that is out of reach.
void place(Camera& camera, const glm::mat4& world_from_node);

/// Length of the longest of a transform's axes; infinite where one is not finite.
float largest_scale(const glm::mat4& m);

/// Object-space bounds of a mesh's vertices [m].
Bounds mesh_bounds(const Mesh& mesh);

/// Whether a transform leaves a box within kMaxCoordinate of the origin; for an empty box, the
/// origin of its space.
bool stays_in_reach(const glm::mat4& world_from_object, const Bounds& box);

/// The transform, if things so placed can be drawn. One that flattens them to a plane keeps the
/// plane and gets a thickness too small to be seen, so that it has an inverse. None where they
/// become a line or a point, or the scale is not within kMinScale to kMaxScale.
std::optional<glm::mat4> drawable(const glm::mat4& world_from_object);

/// drawable, or where there is none or it carries the mesh out of reach, a transform that makes
/// things too small to be seen.
glm::mat4 drawable_or_speck(const glm::mat4& world_from_object, const Bounds& mesh);

}  // namespace lambent
