// SPDX-License-Identifier: Apache-2.0
// Sun and sky of a clear afternoon, for scenes that come without.
#pragma once

#include <glm/glm.hpp>

#include "lambent/scene.h"

namespace lambent {

/// Irradiance of the sun of a clear afternoon on a surface that faces it [W/m^2].
inline constexpr glm::vec3 kDaySunIrradiance{20.0f, 18.0f, 15.0f};

/// A sun whose light travels along `direction_ws` (any length above 0), with that irradiance.
Light make_day_sun(const glm::vec3& direction_ws);

/// Luminance of a surface that reflects all of the light of make_day_sky(1) [W/(m^2 sr)].
inline constexpr float kDaySkyLuminance = 1.25f;

/// The sky of a clear afternoon times `brightness` (>= 0), as a map: blue above, hazy at the
/// horizon, and below it the light that the ground reflects. It is the same all around, so that it
/// suits suns in all directions.
Environment make_day_sky(float brightness);

/// Whether an environment is what make_day_sky() returns, of any brightness and revision.
bool is_day_sky(const Environment& environment);

/// Irradiance of a scene's suns over that of make_day_sun(), by luminance: 0 where it has none. So
/// much brighter than make_day_sky(1) is a sky that suits them.
float sun_ratio(const Scene& scene);

}  // namespace lambent
