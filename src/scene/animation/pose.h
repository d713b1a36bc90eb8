// SPDX-License-Identifier: Apache-2.0
// What the transform of a node does to that which stands there.
#pragma once

#include <glm/glm.hpp>

#include "lambent/scene.h"

namespace lambent {

/// Translation, rotation and scale as a matrix; each may be null, the rotation (x, y, z, w) need
/// not be unit.
glm::dmat4 compose_transform(const double* translation, const double* rotation,
                             const double* scale);

/// Puts a light where the node is, shining along its -Z; nothing where that is nowhere finite.
void place(Light& light, const glm::mat4& world_from_node);

/// Puts a camera where the node is, looking along its -Z; scale, shear and mirroring do not bend
/// it. Nothing where that is nowhere finite.
void place(Camera& camera, const glm::mat4& world_from_node);

/// Whether a transform has a finite inverse.
bool invertible(const glm::mat4& m);

/// The transform, or where it flattens things to nothing one that makes them too small to be seen.
glm::mat4 invertible_or_speck(const glm::mat4& world_from_object);

}  // namespace lambent
