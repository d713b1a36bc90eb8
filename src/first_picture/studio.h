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

/// A sun whose light travels along `direction_ws` (any length above 0), as strong as on a clear
/// afternoon.
Light make_first_sun(const glm::vec3& direction_ws);

/// Irradiance of the sun of a clear afternoon on a surface that faces it [W/m^2], and the radiance
/// of the sky at that time [W/(m^2 sr)].
inline constexpr glm::vec3 kFirstSunIrradiance{20.0f, 18.0f, 15.0f};
inline constexpr glm::vec3 kFirstSky{1.5f, 2.0f, 2.6f};

/// Irradiance of a scene's suns over kFirstSunIrradiance, by luminance: 0 where it has none. So
/// much brighter than kFirstSky is a sky that suits them.
float sun_ratio(const Scene& scene);

}  // namespace lambent
