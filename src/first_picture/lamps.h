// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "first_picture/seen.h"

namespace lambent {

/// Lamps in the room around the camera, where a person would hang them: below its ceiling, away
/// from its walls, and as few as are needed to light most of what the camera sees. At least one.
std::vector<Light> hang_lamps(const World& world, const Camera& camera, const SeenView& view);

}  // namespace lambent
