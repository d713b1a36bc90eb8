// SPDX-License-Identifier: Apache-2.0
// Appends paths to the list of those that go on.
#include "glossy/glossy_records.h"
#include "shared/rays.h"

/// Appends the path of pixel `i` with a ray that starts at the surface `from`, which the path hit
/// with this cone.
void append_way(WayList ways, uint i, CoatPath path, RayCone cone, LitPointRecord from,
                NextRay next) {
  uint at = atomicAdd(ways.count.at[0], 1u);
  ways.paths.at[at] = path;
  ways.cones.at[at] = reflected_cone(cone, path.pdf);
  ways.pixels.at[at] = i;
  ways.rays.at[at] =
      RayRecord(offset_ray_origin(from.position_ws, next.side * from.geometric_normal_ws), 0.0f,
                next.direction_ws, infinity(), kRayMeetsAll);
}
