// SPDX-License-Identifier: Apache-2.0
// A shader as engines have them: looks a field of the default settings up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lambent/shaders/field_lookup.glsl"
#include "twin/engine_lookup.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  EngineLookupArguments arguments;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= arguments.count) return;
  QueryRecord query = arguments.queries.at[i];
  arguments.irradiance.at[i] =
      field_irradiance(arguments.field, query.position_ws, query.normal_ws, query.to_viewer_ws);
}
