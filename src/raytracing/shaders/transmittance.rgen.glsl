// SPDX-License-Identifier: Apache-2.0
// Finds the share of light along each ray that passes the surfaces on it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/glass/absorption.h"
#include "raytracing/vulkan/trace_arguments.h"
#include "shared/rays.h"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};
layout(location = 0) rayPayloadEXT TransmittancePayload light;

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  if (args.to_hits != 0u) ray.t_max = before_hit(args.hits.at[i].distance);
  light = TransmittancePayload(vec3(1.0f), vec3(0.0f), crosses_glass(ray.mask) ? 1u : 0u,
                               stops_at_bends(ray.mask) ? 1u : 0u, 0u);
  uint mask = device_mask(ray.mask);
  if (mask != 0u && ray.t_min <= ray.t_max) {
    // A ray counts as stopped unless the miss shader runs, as no shader runs at hits
    light.stopped = 1u;
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
    traceRayEXT(accelerationStructureEXT(args.structure), flags, mask, 0, 0, 0, ray.origin_ws,
                ray.t_min, ray.direction_ws, min(ray.t_max, kFarthestOfDevices), 0);
  }
  vec3 through = light.through * depth_transmittance(light.optical_depth);
  args.through.at[i] = light.stopped != 0u ? vec3(0.0f) : through;
}
