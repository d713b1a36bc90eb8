// SPDX-License-Identifier: Apache-2.0
// Copies the filtered radiance into the picture, once no pixel reads its neighbours there any more.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "temporal/taa_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  TaaArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(args.frame.width * args.frame.height)) return;
  vec3 radiance = args.result.at[i].radiance;
  args.picture.at[i * args.stride] = radiance.x;
  args.picture.at[i * args.stride + 1u] = radiance.y;
  args.picture.at[i * args.stride + 2u] = radiance.z;
}
