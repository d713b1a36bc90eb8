// SPDX-License-Identifier: Apache-2.0
// Writes the geometry that pixels show, for passes over views.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ViewGeometryArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.points.at[i];
  float depth = -dot(point.position_ws - args.camera_ws, args.camera_back);
  bool seen = (args.surfaces.at[i].flags & kSurfaceMissed) == 0u && depth > 0.0f;
  args.positions_ws.at[i] = seen ? point.position_ws : vec3(0.0f);
  args.normals_ws.at[i] = seen ? point.normal_ws : vec3(0.0f);
  args.depths.at[i] = seen ? depth : 0.0f;
}
