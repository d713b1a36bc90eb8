// SPDX-License-Identifier: Apache-2.0
// Makes visibility rays for those corners of lookups whose visibility is in doubt (see
// VisibilityMask), or for all corners with a weight, one lane per point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  TestCornersArguments args;
};

#include "field/lookup/shaders/lookup_points.glsl"
#include "field/lookup/shaders/allocate_rays.glsl"
#include "field/lookup/shaders/visibility_rays.glsl"

/// The corners of a lookup to test with rays, as bits. Sets the weights of hidden corners to 0.
uint corners_to_test(LookupPoint point, int lookup) {
  if (args.lookups.at[lookup].tile_corner == kNoLookup) return 0u;
  if (args.points.exact != 0u) {
    return weighed_corners(visible_corners(args.lookups.at[lookup].corners, query_of(point)));
  }
  int base = args.lookups.at[lookup].corners.base;
  uvec2 cell_visibility =
      uvec2(args.cell_visibility.at[2 * base], args.cell_visibility.at[2 * base + 1]);
  if (cell_visibility == all_visible()) return 0u;

  CornerWeights corners = args.lookups.at[lookup].corners;
  float total = sum_of_weights(corners);
  VisibilityMask mask = visibility_mask(corners, cell_visibility, total);
  if (mask.hidden != 0u) {
    hide_corners(corners, mask.hidden);
    scale_weights(corners, total);
    args.lookups.at[lookup].corners = corners;
  }
  return mask.tested;
}

void main() {
  LookupPoint point = lookup_point();
  bool exists = is_listed(point);
  uint tested = 0u;
  for (int l = 0; l < kLookups && exists; ++l) {
    tested |= corners_to_test(point, point.lookup + l) << (kCellCorners * l);
  }

  uint ray = allocate_rays(args.counter, uint(bitCount(tested)));
  if (!exists) return;
  args.tests.at[point.place] = CornerTests(ray, tested);
  if (tested == 0u) return;
  QueryRecord query = query_of(point);
  for (int l = 0; l < kLookups; ++l) {
    uint corners = bitfieldExtract(tested, kCellCorners * l, kCellCorners);
    if (corners == 0u) continue;
    LookupGrid volume = grid_of(args.lookups.at[point.lookup + l].corners);
    LookupCell cell = cell_of(volume, query);
    for (; corners != 0u; corners &= corners - 1u) {
      args.rays.at[ray++] = corner_ray(volume.grid, cell, findLSB(corners));
    }
  }
}
