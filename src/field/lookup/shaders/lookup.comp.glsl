// SPDX-License-Identifier: Apache-2.0
// Looks the field up at points, one lane per point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  LookupArguments args;
};

#include "field/correction/shaders/corrections.glsl"
#include "field/probes/shaders/store.glsl"

float fetch_correction(ProbeGrid grid, int volume, vec3 position_ws, vec3 normal_ws) {
  return correction_of(args.corrections, grid, volume, position_ws, normal_ws);
}

#include "field/lookup/lookup.inl.h"

void main() {
  int i = int(gl_GlobalInvocationID.y) * args.width + int(gl_GlobalInvocationID.x);
  // Lanes beyond the last point look up the last one again. No lane returns early, so that lavapipe
  // reads data that all lanes share only once
  QueryRecord query = args.queries.at[min(i, args.count - 1)];
  vec3 irradiance = lookup_irradiance(kVolumes, query.position_ws, query.normal_ws,
                                      query.to_viewer_ws, query.viewer_distance);
  if (i < args.count) args.irradiance.at[i] = irradiance;
}
