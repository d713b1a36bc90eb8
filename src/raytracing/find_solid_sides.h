// SPDX-License-Identifier: Apache-2.0
// Which sides of surfaces bound solid matter, found from where light can come from.
#pragma once

#include <span>

#include "lambent/world.h"
#include "raytracing/solid_sides.h"

namespace lambent {

/// Finds the sides that bound solid matter, from places within the scene's bounds, around them, and
/// in the cells of some grids: those of a field, or none. Open space is where rays leave the scene
/// or meet emissive surfaces, where a point or spot light shines, and whatever a chain of
/// neighbouring places that see each other joins to these. A side of a triangle bounds solid matter
/// if open space sees the other side only. Triangles that open space sees too seldom are judged by
/// their instance, and instances by their winding. Where no place of the grids is open, all of them
/// are taken to be. docs/math.md, "What is solid".
///
/// What sees a room from outside counts for nothing beside what sees it from within, unless
/// `outside_counts`: the outsides of its walls are then open, too.
SolidSides find_solid_sides(const World& world, std::span<const PlaceGrid> grids,
                            bool outside_counts = false);

/// Whether one of the grids has places clearly outside of the scene's bounds.
bool reach_out_of_scene(const World& world, std::span<const PlaceGrid> grids);

}  // namespace lambent
