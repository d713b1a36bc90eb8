// SPDX-License-Identifier: Apache-2.0
// Finds whether something that moved has opened a way into a closed room.
#pragma once

#include <span>
#include <vector>

#include "lambent/scene.h"
#include "lambent/world.h"
#include "raytracing/solid_sides.h"

namespace lambent {

/// Opens the closed places that open neighbours now see, within boxes in which things moved: there,
/// something gave way. Returns whether closed places beyond the boxes are seen as well, as behind a
/// door that has opened; `open_space` is then out of date.
bool reach_closed_places(const World& world, std::span<const Bounds> boxes,
                         std::span<OpenPlaces> open_space);

}  // namespace lambent
