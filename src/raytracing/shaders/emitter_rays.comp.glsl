// SPDX-License-Identifier: Apache-2.0
// Rays that look for emitters about the normals of points, where samples are drawn by the cosine.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/direct_light.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  EmitterRaysArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.points.at[args.first + i];
  RandomStream random = make_random_stream(point.random_index, args.salt, args.seed);
  float share = 1.0f / float(args.emissive_samples);
  for (uint n = 0u; n < args.emissive_samples; ++n) {
    RayRecord ray = no_ray();
    EmitterDraw draw = draw_emitter(random, int(n), share);
    if (point.random_index != kAsksForNoLight && draw.by_cosine != 0u) {
      vec3 direction = emitter_direction(point, draw);
      if (direction != vec3(0.0f)) {
        ray = RayRecord(offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f,
                        direction, infinity(), kRayMeetsAll);
      }
    }
    args.emitter_rays.at[n * args.count + i] = ray;
  }
}
