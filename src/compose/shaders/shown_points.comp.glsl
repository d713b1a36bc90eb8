// SPDX-License-Identifier: Apache-2.0
// Writes the points at which what a band's pixels show in mirrors or behind glass gathers light,
// with their field queries.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ShownPointsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint flags = args.surfaces.at[i].flags & (kSurfaceMissed | kSurfaceSkipped);
  // Rays and lookups of pixels that show nothing are not used, but computed: at a point, since
  // lookups at what is not finite may read outside of the field
  const vec3 up = vec3(0.0f, 1.0f, 0.0f);
  LitPointRecord point = LitPointRecord(vec3(0.0f), up, up, kNoDirectLight, 0u, vec3(0.0f), 0.0f,
                                        uintBitsToFloat(kMissedDistanceBits), 1.0f);
  args.points.at[i] = point;
  args.shown_surfaces.at[i].flags = flags | kSurfaceMissed;
  args.queries.at[i] = QueryRecord(point.position_ws, up, vec3(0.0f), 0.0f);
  if (flags != 0u) return;
  ShownBase base = args.bases.at[i];
  if (base.indirect_albedo == vec3(0.0f)) return;
  args.shown_surfaces.at[i].flags = 0u;
  args.shown_surfaces.at[i].gi_share = base.gi_share;
  point.position_ws = base.position_ws;
  point.normal_ws = base.normal_ws;
  point.geometric_normal_ws = base.geometric_normal_ws;
  args.points.at[i] = point;
  args.queries.at[i] =
      QueryRecord(base.position_ws, base.normal_ws, base.to_viewer_ws, base.viewer_distance);
  atomicAdd(args.points_found.at[0], 1u);
}
