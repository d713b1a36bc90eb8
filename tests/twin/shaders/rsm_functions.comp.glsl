// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin/rsm_functions.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  RsmFunctionsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < args.count) args.results.at[i] = call_rsm_functions(i);
}
