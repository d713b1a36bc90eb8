// SPDX-License-Identifier: Apache-2.0
// Replaces lookups at the hits of rays by what secondary gathers found there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/secondary/secondary_math.h"
#include "field/secondary/secondary_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  SecondaryLightArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  if (ray.mask == 0u) return;
  LitPointRecord point = args.points.at[i];
  args.replaced.at[i] =
      secondary_irradiance(point.normal_ws, point.geometric_normal_ws, ray.direction_ws,
                           args.shaded.at[i], args.direct.at[i], args.field.at[i]);
}
