// SPDX-License-Identifier: Apache-2.0
// What rays met: points that ask for direct light, and all else that the rays bring back.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/sky.glsl"
#include "raytracing/shaders/surface_at.glsl"
#include "raytracing/vulkan/shading_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  HitSurfacesArguments args;
};

void main() {
  if (gl_GlobalInvocationID.x >= args.count) return;
  uint i = args.first + gl_GlobalInvocationID.x;
  RayRecord ray = args.rays.at[i];
  HitRecord hit = args.hits.at[i];
  LitPointRecord point =
      LitPointRecord(ray.origin_ws, -ray.direction_ws, -ray.direction_ws, kAsksForNoLight);
  if (missed(hit)) {
    args.points.at[i] = point;
    args.shaded.at[i] =
        shaded_sky(sky_radiance(args.scene.at[0].environment, ray.direction_ws));
    return;
  }

  // Record the surface
  Surface surface = surface_at(args.scene, ray.direction_ws, hit, args.cone_width * hit.distance);
  point.position_ws = surface.position_ws;
  point.normal_ws = surface.normal_ws;
  point.geometric_normal_ws = surface.geometric_normal_ws;
  ShadedHitRecord shaded =
      shaded_surface(surface, ray.direction_ws, args.max_albedo, args.back_faces_count);

  // Ask for the light that may reach it
  if (shaded.albedo_over_pi != vec3(0.0f)) {
    point.random_index = args.first_indices.at[i / args.rays_per_index] + i % args.rays_per_index;
  }
  args.points.at[i] = point;
  args.shaded.at[i] = shaded;
}
