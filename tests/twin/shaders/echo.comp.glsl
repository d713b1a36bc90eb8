// SPDX-License-Identifier: Apache-2.0
// Writes the members of records one after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin/echo.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  EchoArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  EchoRecord r = args.records.at[i];
  float members[20] = float[](r.a, r.b.x, r.b.y, r.b.z, float(r.c), r.d.x, r.d.y, float(r.e),
                              r.f[0].x, r.f[0].y, r.f[0].z, r.f[1].x, r.f[1].y, r.f[1].z,
                              r.f[2].x, r.f[2].y, r.f[2].z, r.g.x, r.g.y, r.g.w);
  for (int m = 0; m < 20; ++m) args.members.at[20 * i + m] = members[m] * args.scale;
}
