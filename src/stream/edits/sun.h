// SPDX-License-Identifier: Apache-2.0
// The sun's daily course.
#pragma once

#include <glm/glm.hpp>

namespace lambent::stream {

/// Direction in which the sun's light travels at a time of day, at an equinox and a latitude of 45
/// degrees: it rises in the east (+X) at 6, is highest at 12, in the south (+Z), and sets in the
/// west at 18.
glm::vec3 sun_direction(float hours);

/// The sun's irradiance at a time of day, as a share of the full irradiance: it fades near sunset,
/// and is 0 at night.
float sun_share(float hours);

}  // namespace lambent::stream
