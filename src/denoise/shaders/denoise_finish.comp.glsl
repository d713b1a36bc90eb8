// SPDX-License-Identifier: Apache-2.0
// Writes the filtered light: the last pass's result with the detail of its base.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "denoise/denoise_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  DenoiseFinishArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  DenoiseRecord mean = args.in_light.at[i];
  vec3 light = mean.light;
  if (args.has_base != 0u) light = with_detail(light, mean.base, args.base.at[i]);
  if (args.adds != 0u) light += args.filtered.at[i];
  args.filtered.at[i] = light;
}
