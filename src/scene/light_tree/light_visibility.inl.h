// SPDX-License-Identifier: Apache-2.0
// The search for a surface's row of weights, in the common subset of C++ and GLSL. The includer
// provides the type
//   VisibilityRef  the grid and its rows
// and
//   LightVisibilityGrid fetch_visibility_grid(VisibilityRef visibility)
//   uint fetch_visibility_row(VisibilityRef visibility, uint index)

/// The row of the surfaces around a point that face as its unit normal does; kNoVisibilityRow where
/// there is none. A point in the air, whose normal is 0, has none.
LAMBENT_FN uint visibility_row(VisibilityRef visibility, vec3 position_ws, vec3 normal_ws) {
  LightVisibilityGrid grid = fetch_visibility_grid(visibility);
  if (grid.cells_per_metre <= 0.0f || normal_ws == vec3(0.0f)) return kNoVisibilityRow;
  uint side = facing_side(normal_ws);
  vec3 coords = visibility_coords(grid, position_ws, normal_ws);
  uint index = visibility_index(grid, jittered_coords(coords, side), side);
  uint row = kNoVisibilityRow;
  if (index != kOutsideVisibility) row = fetch_visibility_row(visibility, index);
  if (row != kNoVisibilityRow) return row;
  index = visibility_index(grid, coords, side);
  return index == kOutsideVisibility ? kNoVisibilityRow : fetch_visibility_row(visibility, index);
}
