// SPDX-License-Identifier: Apache-2.0
// Rays for the corners of lookups that distances do not decide: a lane a point. Rays lie in the
// order in which groups come to ask, which differs from time to time; each point knows its own.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/device_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  AskCornersArguments args;
};
shared uint asked_by_group, first_of_group;

#include "field/shaders/lookup_points.glsl"
#include "field/shaders/seen_corners.glsl"

/// Asks for corners of a lookup, by their bits. Hides those that are not worth it.
uint corners_to_ask(int lookup, QueryRecord query) {
  if (args.lookups.at[lookup].tile_corner == kNoLookup) return 0u;
  CornerWeights corners = args.lookups.at[lookup].corners;
  if (args.points.exact != 0u) return weighed_corners(seen_corners(corners, query));

  int from = sight_bit(heaviest_corner(corners), 0);
  uint seen = args.sights.at[2 * corners.base + (from >> 5)] >> (from & 31);
  float share = sum_of_weights(corners);
  CornerDoubts doubts = doubtful_corners(corners, seen, share);
  if (doubts.hidden != 0u) {
    hide_corners(corners, doubts.hidden, share);
    args.lookups.at[lookup].corners = corners;
  }
  return doubts.asked;
}

void main() {
  LookupPoint point = lookup_point();
  uint asked = 0u;
  for (int l = 0; l < kLookups && point.exists && point.reads; ++l) {
    asked |= corners_to_ask(point.lookup + l, point.query) << (kCellCorners * l);
  }

  // Find room for the rays of the group, and in it for those of the point
  if (gl_LocalInvocationIndex == 0u) asked_by_group = 0u;
  barrier();
  uint before = atomicAdd(asked_by_group, uint(bitCount(asked)));
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    first_of_group = atomicAdd(args.counter.at[kRaysAsked], asked_by_group);
    atomicAdd(args.counter.at[kRaysEver], asked_by_group);
  }
  barrier();
  if (!point.exists) return;
  uint ray = first_of_group + before;
  args.questions.at[point.place] = CornerQuestions(ray, asked);
  for (int l = 0; l < kLookups; ++l) {
    uint corners = bitfieldExtract(asked, kCellCorners * l, kCellCorners);
    if (corners == 0u) continue;
    CornerWeights weights = args.lookups.at[point.lookup + l].corners;
    for (; corners != 0u; corners &= corners - 1u) {
      args.rays.at[ray++] = corner_ray(weights, findLSB(corners), point.query);
    }
  }
}
