// SPDX-License-Identifier: Apache-2.0
// Finds the nearest hit of each ray. Rays that carry a pixel's sample go on through surfaces that
// do not end it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/find_closest.glsl"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};

void main() {
  uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  OrderedCoverage met = start_coverage(ray.mask);
  bool ended = false;
  while (!ended) {
    find_closest(args.structure, ray, gl_RayFlagsNoneEXT, device_mask(ray.mask), met.passed);
    ended = missed(found.hit) || ends_sample(met, found.share, found.hit.distance);
    ray.t_min = restart_distance(met);
    ray.mask = met.ray_mask;
  }
  found.hit.sample_weight = weight_of_sample(met);
  args.hits.at[i] = found.hit;
}
