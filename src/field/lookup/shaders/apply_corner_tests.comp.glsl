// SPDX-License-Identifier: Apache-2.0
// Computes the weights of lookups from the results of their visibility rays, one lane per point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  ApplyCornerTestsArguments args;
};

#include "field/lookup/shaders/lookup_points.glsl"
#include "field/lookup/shaders/visibility_rays.glsl"

void main() {
  LookupPoint point = lookup_point();
  if (!is_listed(point)) return;
  CornerTests tests = args.tests.at[point.place];
  uint ray = tests.first_ray;
  for (int l = 0; l < kLookups; ++l) {
    uint tested = bitfieldExtract(tests.tested, kCellCorners * l, kCellCorners);
    if (tested == 0u) continue;
    uint hidden = 0u;
    for (; tested != 0u; tested &= tested - 1u) {
      if (args.occluded.at[ray++] != 0u) hidden |= 1u << findLSB(tested);
    }
    CornerWeights corners = args.lookups.at[point.lookup + l].corners;
    float total = sum_of_weights(corners);
    if (args.points.exact == 0u) {
      int first = 2 * corners.base;
      uvec2 cell_visibility =
          uvec2(args.cell_visibility.at[first], args.cell_visibility.at[first + 1]);
      args.lookups.at[point.lookup + l].corners =
          tested_weights(corners, hidden, cell_visibility, total);
      continue;
    }
    corners = visible_corners(corners, query_of(point));
    hide_corners(corners, hidden);
    // Where no probe is visible, the weights by distances stay
    if (scale_weights(corners, total) != 0) args.lookups.at[point.lookup + l].corners = corners;
  }
}
