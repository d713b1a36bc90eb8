// SPDX-License-Identifier: Apache-2.0
// Tests alpha and transmission as the host does. Not called for opaque triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/shaders/surface_at.glsl"
#include "raytracing/vulkan/trace_arguments.h"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};
layout(location = 0) rayPayloadInEXT ClosestPayload found;
hitAttributeEXT vec2 barycentrics;

void main() {
  uint instance = uint(gl_InstanceCustomIndexEXT);
  uint triangle = uint(gl_PrimitiveID);
  HitCoverage coverage = hit_coverage_at(args.scene, instance, triangle, barycentrics);
  if (!stops_ray(coverage, triangle, barycentrics, gl_HitTEXT, found.mask, found.passed)) {
    ignoreIntersectionEXT;
  }
  found.instance = instance;
  found.triangle = triangle;
  found.share = covered_share(coverage);
  if (!crosses_glass(found.mask)) return;
  if (!is_transmissive(material_of(args.scene, instance))) return;
  bool from_front = gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT;
  vec3 share = straight_share_at(args.scene, instance, triangle, barycentrics, from_front,
                                 gl_WorldRayDirectionEXT);
  if (passes_glass(share, triangle, gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT)) {
    ignoreIntersectionEXT;
  }
}
