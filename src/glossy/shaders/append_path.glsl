// SPDX-License-Identifier: Apache-2.0
// Appends paths to the list of those that go on.
#include "glossy/glossy_records.h"
#include "shared/rays.h"

/// Writes the path of pixel `i` to place `at` of a list, with a ray that starts at the surface
/// `from`, which the path hit with this cone.
void write_path(PathList list, uint at, uint i, CoatPath path, RayCone cone, LitPointRecord from,
                NextRay next) {
  list.paths.at[at] = path;
  list.cones.at[at] = reflected_cone(cone, path.pdf);
  list.pixels.at[at] = i;
  list.rays.at[at] =
      RayRecord(offset_ray_origin(from.position_ws, next.side * from.geometric_normal_ws), 0.0f,
                next.direction_ws, infinity(), kRayMeetsAll);
}

/// Appends a path, see write_path().
void append_path(PathList list, uint i, CoatPath path, RayCone cone, LitPointRecord from,
                 NextRay next) {
  write_path(list, atomicAdd(list.count.at[0], 1u), i, path, cone, from, next);
}
