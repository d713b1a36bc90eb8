// SPDX-License-Identifier: Apache-2.0
// Tests alpha and transmission as the host does: transmissive surfaces occlude nothing. Not called
// for opaque triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/shaders/surface_at.glsl"
#include "raytracing/vulkan/trace_arguments.h"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};
hitAttributeEXT vec2 barycentrics;

void main() {
  uint instance = uint(gl_InstanceCustomIndexEXT);
  uint triangle = uint(gl_PrimitiveID);
  HitCoverage coverage = hit_coverage_at(args.scene, instance, triangle, barycentrics);
  if (!stops_ray(coverage, triangle, barycentrics, gl_HitTEXT, kRayMeetsAll, kNothingPassed)) {
    ignoreIntersectionEXT;
  }
  if (!is_transmissive(material_of(args.scene, instance))) return;
  bool from_front = gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT;
  vec3 share = straight_share_at(args.scene, instance, triangle, barycentrics, from_front,
                                 gl_WorldRayDirectionEXT);
  if (share != vec3(0.0f)) ignoreIntersectionEXT;
}
