// SPDX-License-Identifier: Apache-2.0
// Writes a ray's hit. The facing is that in object space, as on the host: mirroring a mesh does not
// flip its faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/ray_records.h"

layout(location = 0) rayPayloadInEXT HitRecord hit;
hitAttributeEXT vec2 barycentrics;

void main() {
  hit = HitRecord(gl_HitTEXT, uint(gl_InstanceCustomIndexEXT), uint(gl_PrimitiveID), barycentrics,
                  gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT ? 1u : 0u);
}
