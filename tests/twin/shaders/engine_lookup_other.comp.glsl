// SPDX-License-Identifier: Apache-2.0
// The same of a field of other tiles and formats.
#version 460
#extension GL_GOOGLE_include_directive : require
#define LAMBENT_IRRADIANCE_TEXELS 6
#define LAMBENT_DISTANCE_TEXELS 8
#define LAMBENT_IRRADIANCE_FORMAT kR11g11b10f
#define LAMBENT_DISTANCE_FORMAT kRg32f
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
