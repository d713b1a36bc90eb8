// SPDX-License-Identifier: Apache-2.0
// Lights for scenes that come without any.
#pragma once

#include <glm/glm.hpp>

#include "lambent/scene.h"

namespace lambent {

/// A studio as a latitude-longitude environment: neutral walls, and soft boxes as key, fill and
/// rim. `front_ws` is the horizontal unit direction from the subject to the camera.
Environment make_studio(const glm::vec3& front_ws);

/// The key light once more, as a light without extent, so that the subject casts crisp shadows.
Light make_key_light(const glm::vec3& front_ws);

}  // namespace lambent
