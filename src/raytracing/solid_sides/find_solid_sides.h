// SPDX-License-Identifier: Apache-2.0
// Finds which sides of surfaces bound solid matter, from where light can come from.
#pragma once

#include <span>

#include "lambent/world.h"
#include "raytracing/solid_sides/solid_sides.h"

namespace lambent {

/// Finds the sides that bound solid matter, from sample places within the scene's bounds, around
/// them, and in the cells of the given grids (those of a field, or none). A place is in open space
/// where rays from it leave the scene or hit emissive surfaces, where a point or spot light shines,
/// or where a chain of neighbouring, mutually visible places leads to such a place. So are places
/// in rooms where it is dark, if their walls are single-sided and face them. A side of a triangle
/// bounds solid matter if only the other side is visible from open space. Triangles that are
/// visible too seldom are judged by their instance, and instances by their winding. Where no place
/// of the grids is open, all of them are taken to be. docs/math.md, "What is solid".
///
/// Views of a room from outside are ignored where there are views from within, unless
/// `outside_counts`: then the outsides of its walls are open, too.
///
/// `before`: the open places that were found when only lights were different; empty: none. What was
/// open stays open.
SolidSides find_solid_sides(const World& world, std::span<const PlaceGrid> grids,
                            bool outside_counts = false, std::span<const OpenPlaces> before = {});

/// Whether one of the grids has places clearly outside of the scene's bounds.
bool reach_out_of_scene(const World& world, std::span<const PlaceGrid> grids);

}  // namespace lambent
