// SPDX-License-Identifier: Apache-2.0
// How much of a scene's lights is visible from where, for picking lights: a grid of cells, in which
// the surfaces that face one way share a row of weights, one for each cluster of lights at the top
// of the light tree.
#ifndef LAMBENT_SCENE_LIGHT_VISIBILITY_MATH_H
#define LAMBENT_SCENE_LIGHT_VISIBILITY_MATH_H

#include "scene/light_tree/light_tree_math.h"
#include "shared/place_hash.h"

LAMBENT_BEGIN

// The groups of the light tree whose nodes have weights: that of the root, and those of its
// children.
const uint kGroupsWithVisibility = 1u + kLightGroupSize;

// Number of ways that a surface can face: along an axis or against it.
const uint kFacingSides = 6u;

// Row of surfaces about which nothing is known.
const uint kNoVisibilityRow = 0xFFFFFFFFu;

// Index of points outside of the grid.
const uint kOutsideVisibility = 0xFFFFFFFFu;

// Weights are stored in bytes, of which this one is a weight of 1.
const float kWholeVisibility = 255.0f;

/// A weight, above 0 and up to 1, as it is stored.
LAMBENT_FN float visibility_weight(uint stored) {
  return float(stored) * (1.0f / kWholeVisibility);
}

// Points are moved by this share of a cell's edge along their normals, so that walls which lie
// between two cells, within rounding, belong to one of them.
const float kCellsInFront = 0.25f;

/// The grid over a box.
struct LightVisibilityGrid {
  vec3 min_ws;            ///< The box's corner [m].
  float cells_per_metre;  ///< 0: there is no grid.
  uvec3 size;             ///< Cells along each axis.
  uint row_length;        ///< Weights in a row, a multiple of kLightGroupSize.
};

/// Which way a surface with this normal faces: the axis, plus 3 against it.
LAMBENT_FN uint facing_side(vec3 normal_ws) {
  vec3 size = abs(normal_ws);
  uint axis = size.x >= size.y && size.x >= size.z ? 0u : (size.y >= size.z ? 1u : 2u);
  return normal_ws[axis] < 0.0f ? axis + 3u : axis;
}

/// The place of a point in the grid [cells].
LAMBENT_FN vec3 visibility_coords(LightVisibilityGrid grid, vec3 position_ws, vec3 normal_ws) {
  return (position_ws - grid.min_ws) * grid.cells_per_metre + kCellsInFront * normal_ws;
}

/// The index of a cell's side; kOutsideVisibility outside of the grid.
LAMBENT_FN uint visibility_index(LightVisibilityGrid grid, vec3 coords, uint side) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(coords[axis] >= 0.0f && coords[axis] < float(grid.size[axis]))) return kOutsideVisibility;
  }
  uvec3 cell = uvec3(coords);
  return ((cell.z * grid.size.y + cell.y) * grid.size.x + cell.x) * kFacingSides + side;
}

/// A point up to half a cell away along the surface, at random, so that no pattern of noise shows
/// where cells end.
LAMBENT_FN vec3 jittered_coords(vec3 coords, uint side) {
  vec3 jitter = hash_of_place(coords) - vec3(0.5f);
  jitter[side % 3u] = 0.0f;
  return coords + jitter;
}

LAMBENT_END
#endif
