// SPDX-License-Identifier: Apache-2.0
// Every formula between a hit and its light, once for each index.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin/shading_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ShadingMathArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < args.count) args.results.at[i] = evaluate_shading_math(i);
}
