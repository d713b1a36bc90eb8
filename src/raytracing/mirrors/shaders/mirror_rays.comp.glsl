// SPDX-License-Identifier: Apache-2.0
// Draws the rays that go on at mirrors, one lane per hit. The twin of follow_mirrors() in
// shade_hits.cpp, with mirror_light.comp.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/mirrors/mirror_math.h"
#include "raytracing/vulkan/shading_records.h"
#include "shared/rays.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  MirrorRaysArguments args;
};

void main() {
  if (gl_GlobalInvocationID.x >= args.count) return;
  uint i = args.first + gl_GlobalInvocationID.x;
  LitPointRecord point = args.points.at[i];
  ShadedHitRecord hit = args.shaded.at[i];
  RayRecord ray = no_ray();
  // Rays that met no mirror before have none behind it
  bool first_or_behind = args.mirrors == 0u || hit.mirror_distance > 0.0f;
  if (first_or_behind && goes_on(hit, point.albedo_shape, point.normal_ws, point.to_viewer_ws)) {
    RandomStream random = make_random_stream(point.random_index, args.salt, args.seed);
    vec3 direction_ws =
        sample_mirror(point.albedo_shape, point.normal_ws, point.geometric_normal_ws,
                      point.to_viewer_ws, next_uniform2(random));
    ray = RayRecord(offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f,
                    direction_ws, uintBitsToFloat(kMissedDistanceBits), args.rays.at[i].mask);
  }
  args.reflected.at[i] = ray;
}
