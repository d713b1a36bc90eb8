// SPDX-License-Identifier: Apache-2.0
// Appends ways to lists of those that go on.
#include "glossy/glossy_records.h"
#include "shared/rays.h"

/// Has the way of pixel `i` go on along a ray from the surface at `from`, which it met with this
/// cone.
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
