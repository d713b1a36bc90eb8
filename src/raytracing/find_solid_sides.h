// SPDX-License-Identifier: Apache-2.0
// Which sides of surfaces bound solid matter, found from where light can come from.
#pragma once

#include <span>

#include "lambent/world.h"
#include "raytracing/solid_sides.h"

namespace lambent {

/// A regular grid of places from which the scene is looked at.
struct PlaceGrid {
  glm::vec3 origin_ws{0.0f};  ///< Place (0, 0, 0) [m].
  glm::mat3 axes{1.0f};       ///< Columns: the grid's axes in world space, unit and orthogonal.
  glm::vec3 spacing{1.0f};    ///< Distance of neighbouring places along each axis [m], > 0.
  glm::ivec3 count{2};        ///< Places along each axis, >= 2. Cost is in proportion.
};

/// Finds the sides that bound solid matter from the places of some grids. Open space is
/// where rays leave the scene or meet emissive surfaces, where a point or spot light shines from,
/// and whatever a chain of neighbouring places that see each other joins to these. A side of a
/// triangle bounds solid matter if open space sees the other side only. Triangles that open space
/// sees too seldom are judged by their instance, and instances by their winding. Where no place is
/// open, all are taken to be.
SolidSides find_solid_sides(const World& world, std::span<const PlaceGrid> grids);

}  // namespace lambent
