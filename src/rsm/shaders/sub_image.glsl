// SPDX-License-Identifier: Apache-2.0
// Each workgroup processes one sub-image. Neighbouring workgroups process the same part of the
// picture in one sub-image after the other, so that what they read of it stays in the cache.
#include "rsm/deinterleave.h"

layout(constant_id = 0) const int kSubImages = 1;  // along an edge of the mosaic

/// The sub-image of this workgroup among units x units.
ivec2 sub_image_of_group(int units) {
  int sub = int(gl_WorkGroupID.x) % (units * units);
  return ivec2(sub % units, sub / units);
}

/// First place of this workgroup's tile; `first_row`: row of tiles of the first workgroups.
ivec2 tile_of_group(int units, int first_row) {
  return ivec2(int(gl_WorkGroupID.x) / (units * units), int(gl_WorkGroupID.y) + first_row) *
         ivec2(gl_WorkGroupSize);
}
