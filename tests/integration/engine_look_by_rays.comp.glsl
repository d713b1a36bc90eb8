// SPDX-License-Identifier: Apache-2.0
// The engine looks the field up, and sees its probes by ray queries in its own structure.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
layout(set = 0, binding = 0) uniform accelerationStructureEXT structure;

bool field_occluded(vec3 origin_ws, vec3 direction_ws, float distance) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, structure, gl_RayFlagsOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT,
                        0xFFu, origin_ws, 0.0, direction_ws, distance);
  rayQueryProceedEXT(query);
  return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}
#define LAMBENT_VISIBILITY_RAYS
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
  irradiance.at[i] =
      field_irradiance_by_rays(field.at[0], positions.at[2 * i], normal, normal);
}
