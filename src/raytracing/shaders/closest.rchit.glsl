// SPDX-License-Identifier: Apache-2.0
// Writes a ray's hit. The facing is that in object space, as on the host: mirroring a mesh does not
// flip its faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/vulkan/trace_arguments.h"

layout(location = 0) rayPayloadInEXT ClosestPayload found;
hitAttributeEXT vec2 barycentrics;

void main() {
  uint instance = uint(gl_InstanceCustomIndexEXT);
  uint triangle = uint(gl_PrimitiveID);
  // What was tested last may be behind this hit
  if (instance != found.instance || triangle != found.triangle) found.share = 1.0f;
  found.hit = HitRecord(gl_HitTEXT, instance, triangle, barycentrics,
                        gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT ? 1u : 0u, 1.0f);
}
