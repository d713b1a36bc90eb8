// SPDX-License-Identifier: Apache-2.0
// Looks the field up at points: a lane a point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  LookupArguments args;
};

#include "field/probes/shaders/store.glsl"
#include "field/lookup/lookup.inl.h"

void main() {
  int i = int(gl_GlobalInvocationID.y) * args.width + int(gl_GlobalInvocationID.x);
  // Lanes beyond the last point look that up once more: none leaves early, which is what lets
  // processors read what all lanes share once
  QueryRecord query = args.queries.at[min(i, args.count - 1)];
  vec3 irradiance =
      lookup_irradiance(kVolumes, query.position_ws, query.normal_ws, query.to_viewer_ws);
  if (i < args.count) args.irradiance.at[i] = irradiance;
}
