// SPDX-License-Identifier: Apache-2.0
// The engine looks the field up: here at points of its own, elsewhere at pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field_lookup.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  FieldRecordArray field;
  Vec3Array positions;  // each followed by its normal
  Vec3Array irradiance;
  uint count;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec3 normal = positions.at[2 * i + 1];
  irradiance.at[i] = field_irradiance(field.at[0], positions.at[2 * i], normal, normal);
}
