// SPDX-License-Identifier: Apache-2.0
// Rays for the corners of lookups that distances do not decide: a lane a point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  AskCornersArguments args;
};

#include "field/lookup/shaders/lookup_points.glsl"
#include "field/lookup/shaders/ray_room.glsl"
#include "field/lookup/shaders/seen_corners.glsl"

/// Corners of a lookup to ask for, by their bits. Hides those that are not worth it.
uint corners_to_ask(LookupPoint point, int lookup) {
  if (args.lookups.at[lookup].tile_corner == kNoLookup) return 0u;
  if (args.points.exact != 0u) {
    return weighed_corners(seen_corners(args.lookups.at[lookup].corners, query_of(point)));
  }
  int base = args.lookups.at[lookup].corners.base;
  uint sights[2] = uint[2](args.sights.at[2 * base], args.sights.at[2 * base + 1]);
  if ((sights[0] & sights[1]) == 0xFFFFFFFFu) return 0u;

  CornerWeights corners = args.lookups.at[lookup].corners;
  int from = sight_bit(heaviest_corner(corners), 0);
  float share = sum_of_weights(corners);
  CornerDoubts doubts = doubtful_corners(corners, sights[from >> 5] >> (from & 31), share);
  if (doubts.hidden != 0u) {
    hide_corners(corners, doubts.hidden, share);
    args.lookups.at[lookup].corners = corners;
  }
  return doubts.asked;
}

void main() {
  LookupPoint point = lookup_point();
  uint asked = 0u;
  for (int l = 0; l < kLookups && point.exists; ++l) {
    asked |= corners_to_ask(point, point.lookup + l) << (kCellCorners * l);
  }

  uint ray = room_for_rays(args.counter, uint(bitCount(asked)));
  if (!point.exists) return;
  args.questions.at[point.place] = CornerQuestions(ray, asked);
  if (asked == 0u) return;
  QueryRecord query = query_of(point);
  for (int l = 0; l < kLookups; ++l) {
    uint corners = bitfieldExtract(asked, kCellCorners * l, kCellCorners);
    if (corners == 0u) continue;
    CornerWeights weights = args.lookups.at[point.lookup + l].corners;
    for (; corners != 0u; corners &= corners - 1u) {
      args.rays.at[ray++] = corner_ray(weights, findLSB(corners), query);
    }
  }
}
