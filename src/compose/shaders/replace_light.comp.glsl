// SPDX-License-Identifier: Apache-2.0
// Subtracts another method's share of light from the field's, and adds that method's own result.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/rsm/replace_light.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ReplaceLightArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  vec3 subtracted = args.subtracts != 0u ? args.subtracted_field.at[i] : vec3(0.0f);
  args.irradiance.at[i] = replaced_light(args.irradiance.at[i], args.added.at[i], subtracted);
}
