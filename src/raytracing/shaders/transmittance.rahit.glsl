// SPDX-License-Identifier: Apache-2.0
// Multiplies a ray's light by the share that passes a surface, as the host does. Not called for
// opaque triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/glass/absorption.h"
#include "raytracing/shaders/surface_at.glsl"
#include "raytracing/vulkan/trace_arguments.h"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};
layout(location = 0) rayPayloadInEXT TransmittancePayload light;
hitAttributeEXT vec2 barycentrics;

void main() {
  uint instance = uint(gl_InstanceCustomIndexEXT);
  uint triangle = uint(gl_PrimitiveID);
  MaterialRecord material = material_of(args.scene, instance);
  HitCoverage coverage = hit_coverage_at(args.scene, instance, triangle, barycentrics);
  if (dims_ray(coverage, light.crosses != 0u) && !is_transmissive(material)) {
    light.through *= 1.0f - covered_share(coverage);
    if (light.through != vec3(0.0f)) ignoreIntersectionEXT;
    return;
  }
  if (!stops_ray(coverage, triangle, barycentrics, gl_HitTEXT, kRayMeetsAll, kNothingPassed)) {
    ignoreIntersectionEXT;
  }
  if (!is_transmissive(material)) return;
  bool from_front = gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT;
  vec3 share = straight_share_at(args.scene, instance, triangle, barycentrics, from_front,
                                 gl_WorldRayDirectionEXT);
  if (share == vec3(0.0f)) return;
  if (light.stops_at_bends != 0u && bends_light_at(args.scene, instance, triangle, barycentrics)) {
    return;
  }
  light.through *= light.crosses != 0u ? share / passing_probability(share) : share;
  if (bounds_volume(material)) {
    light.optical_depth += depth_at_boundary(material.absorption, gl_HitTEXT, from_front);
  }
  ignoreIntersectionEXT;
}
