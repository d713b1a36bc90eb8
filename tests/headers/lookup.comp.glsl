// SPDX-License-Identifier: Apache-2.0
// The bridged lookup loop over bindings of a shader's own.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "field/lookup/lookup.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Probes { vec4 irradiance_and_distance[]; } probes;
layout(scalar, binding = 1) buffer Points { vec3 points[]; } io;
layout(scalar, binding = 2) readonly buffer Volumes { ProbeGrid grids[]; } volumes;

ProbeGrid fetch_grid(int volume) {
  return volumes.grids[volume];
}

vec2 fetch_moments(int probe, vec3 direction) {
  float mean = probes.irradiance_and_distance[probe].w + 0.0 * direction.x;
  return vec2(mean, mean * mean);
}

vec3 fetch_offset(int probe) {
  return decode_probe_offset(uint(probe));
}

vec3 fetch_irradiance(int probe, vec3 direction) {
  return probes.irradiance_and_distance[probe].xyz + vec3(0.0 * direction.x);
}

float fetch_correction(ProbeGrid grid, int volume, vec3 position_ws, vec3 normal_ws) {
  return 1.0 + 0.0 * (float(volume) + position_ws.x + normal_ws.x);
}

#include "field/lookup/lookup.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  vec3 up = vec3(0.0, 1.0, 0.0);
  io.points[i] = lookup_irradiance(volumes.grids.length(), io.points[i], up, up, 1.0);
}
