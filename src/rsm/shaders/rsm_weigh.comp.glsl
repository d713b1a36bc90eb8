// SPDX-License-Identifier: Apache-2.0
// Computes the light of a watt of each cluster at points of the view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/vulkan/device_maps.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  WeighArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(args.count) || args.clusters.at[i].found == 0u) return;
  RsmTexelRecord texel = args.clusters.at[i].texel;
  TermSums sums = TermSums(0.0f, 0.0f);
  for (int k = 0; k < kViewPoints; ++k) {
    float term = bounded_geometry_term(args.points.at[k], args.points.at[kViewPoints + k],
                                       texel.position_ws, texel.normal_ws, texel.softening);
    sums.terms += term;
    sums.squares += term * term;
  }
  args.clusters.at[i].brought = sums;
}
