// SPDX-License-Identifier: Apache-2.0
// Which hits stop their rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/scene_fetch.glsl"
#include "twin/coverage.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CoverageArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  HitRecord hit = args.hits.at[i];
  HitCoverage coverage =
      hit_coverage_at(args.scene, hit.instance, hit.triangle, hit.barycentrics);
  bool stops = stops_ray(coverage, hit.triangle, hit.barycentrics, hit.distance, mask_of_ray(i),
                         kPassed);
  args.stops.at[i] = stops ? 1u : 0u;
}
