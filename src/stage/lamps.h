// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stage/seen.h"

namespace lambent {

/// Lamps that a person would hang in the room around the camera: below its ceiling, away from its
/// walls, as few as light most of what the camera sees. At least one.
std::vector<Light> hang_lamps(const World& world, const Camera& camera, const SeenView& view);

}  // namespace lambent
