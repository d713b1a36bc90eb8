// SPDX-License-Identifier: Apache-2.0
// How the walls of a scene are turned, and its bounds along them.
#pragma once

#include "lambent/scene.h"

namespace lambent {

/// Rotation about +Y after which most of a scene's walls face along the axes: columns are these
/// axes in world space. The identity where walls face so already, or anywhere.
glm::mat3 axes_of_walls(const Scene& scene);

/// The bounds of a scene's vertices along some axes [m].
Bounds bounds_along(const Scene& scene, const glm::mat3& axes);

}  // namespace lambent
