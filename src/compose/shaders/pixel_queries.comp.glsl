// SPDX-License-Identifier: Apache-2.0
// Writes the pixels' field queries.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"
#include "glossy/glossy_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  PixelQueriesArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.points.at[i];
  PixelSurfaceRecord surface = args.surfaces.at[i];
  vec3 to_viewer_ws = surface.to_viewer_ws;
  vec3 normal_ws = args.mirrored != 0u ? coat_direction(point.normal_ws, to_viewer_ws,
                                                        surface.reflectance.alpha)
                                       : point.normal_ws;
  args.queries.at[i] = QueryRecord(point.position_ws, normal_ws, to_viewer_ws, infinity());
}
