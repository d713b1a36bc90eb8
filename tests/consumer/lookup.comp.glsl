// SPDX-License-Identifier: Apache-2.0
// A shader of somebody else's that looks the field up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field_lookup.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  FieldRecord field;
  Vec3Array irradiance;
};

void main() {
  vec3 up = vec3(0.0, 1.0, 0.0);
  irradiance.at[gl_GlobalInvocationID.x] =
      field_irradiance(field, vec3(gl_GlobalInvocationID), up, up);
}
