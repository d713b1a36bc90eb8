// SPDX-License-Identifier: Apache-2.0
// The sun's daily course.
#pragma once

#include <glm/glm.hpp>

namespace lambent::stream {

/// Way that the sun's light travels at a time of day, at an equinox on 45 degrees of latitude: it
/// rises in the east (+X) at 6, is highest at 12, in the south (+Z), and sets in the west at 18.
glm::vec3 sun_direction(float hours);

/// Share of its full irradiance that the sun has at a time of day: it fades as it sets, and at
/// night there is none.
float sun_share(float hours);

}  // namespace lambent::stream
