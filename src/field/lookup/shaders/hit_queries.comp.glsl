// SPDX-License-Identifier: Apache-2.0
// Writes field queries for the hits of rays, one lane per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  HitQueriesArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.hit_points.at[i];
  RayRecord ray = args.rays.at[i];
  // Lookups by rays skip a query with a normal of 0
  bool asks = ray.mask != 0u && reads_field(args.shaded.at[i]);
  vec3 normal_ws = asks ? point.normal_ws : vec3(0.0);
  args.queries.at[i] =
      QueryRecord(point.position_ws, normal_ws, point.to_viewer_ws, point.viewer_distance);
}
