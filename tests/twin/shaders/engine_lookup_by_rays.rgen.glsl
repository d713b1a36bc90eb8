// SPDX-License-Identifier: Apache-2.0
// A shader as engines have them: looks a field of coarse distance tiles up, and sees its probes by
// rays in the engine's structure.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "twin/engine_lookup.h"

layout(push_constant, scalar) uniform Push {
  EngineLookupByRaysArguments arguments;
};
layout(location = 0) rayPayloadEXT uint occluded;

bool field_occluded(vec3 origin_ws, vec3 direction_ws, float distance) {
  occluded = 1u;
  uint flags = gl_RayFlagsOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT |
               gl_RayFlagsSkipClosestHitShaderEXT;
  traceRayEXT(accelerationStructureEXT(arguments.structure), flags, 0xFFu, 0, 0, 0, origin_ws, 0.0,
              direction_ws, distance, 0);
  return occluded != 0u;
}

#define LAMBENT_VISIBILITY_RAYS
#define LAMBENT_DISTANCE_TEXELS 4
#include "lambent/shaders/field_lookup.glsl"

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= arguments.lookup.count) return;
  QueryRecord query = arguments.lookup.queries.at[i];
  arguments.lookup.irradiance.at[i] = field_irradiance_by_rays(
      arguments.lookup.field, query.position_ws, query.normal_ws, query.to_viewer_ws);
}
