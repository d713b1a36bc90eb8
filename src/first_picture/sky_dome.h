// SPDX-License-Identifier: Apache-2.0
// What the skies that scenes bring as meshes show.
#pragma once

#include <optional>

#include "lambent/scene.h"

namespace lambent {

/// Luminance [W/(m^2 sr)] of a level surface that reflects all of the light of a sky's map; none
/// unless that shows a clear day in colours without a unit, as painted skies do: blue, and nowhere
/// brighter than white, as a sun would be. Nights, dusks and overcast skies have none.
std::optional<float> clear_day_luminance(const Environment& sky);

}  // namespace lambent
