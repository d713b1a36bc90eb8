// SPDX-License-Identifier: Apache-2.0
// Converts sampled light to the format that passes of the filter read.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "denoise/denoise_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  DenoiseStartArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  vec3 light = finite_or_dark(args.light.at[i]);
  vec3 base = args.has_base != 0u ? finite_or_dark(args.base.at[i]) : vec3(0.0f);
  float spread = args.measured != 0u ? finite_or_dark(args.variance.at[i])
                                     : unmeasured_spread(light, base);
  args.out_light.at[i] = DenoiseRecord(light, spread, base, 1.0f);
}
