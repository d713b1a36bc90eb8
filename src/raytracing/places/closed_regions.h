// SPDX-License-Identifier: Apache-2.0
// Finds whether something that moved has opened a way into a closed room.
#pragma once

#include <span>
#include <vector>

#include "lambent/scene.h"
#include "lambent/world.h"
#include "raytracing/solid_sides/solid_sides.h"

namespace lambent {

/// Whether open places now see into a closed region, because something in these boxes gave way: a
/// closed place that is in none of the boxes, as behind a door that has opened, or more closed
/// places than a thing that moved on leaves behind. `open_space` is then out of date. Otherwise,
/// the places that were seen within the boxes are opened.
bool opens_closed_region(const World& world, std::span<const Bounds> boxes,
                         std::vector<OpenPlaces>& open_space);

}  // namespace lambent
