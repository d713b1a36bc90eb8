// SPDX-License-Identifier: Apache-2.0
// Writes the field queries at the hits of gathering rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather/gather_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  RayQueriesArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.points.at[i];
  args.queries.at[i] = QueryRecord(point.position_ws, point.normal_ws, point.to_viewer_ws,
                                   point.viewer_distance);
}
