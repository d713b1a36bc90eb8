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
  ShadedHitRecord shaded = ShadedHitRecord(vec3(0.0f), vec3(0.0f), 0u, kSurfaceMissed);
  if (missed(hit)) {
    shaded.radiance = sky_radiance(args.scene.at[0].environment, ray.direction_ws);
    shaded.flags |= kSurfaceReceivesGi;
    args.points.at[i] = point;
    args.shaded.at[i] = shaded;
    return;
  }

  // Record the surface
  Surface surface = surface_at(args.scene, ray.direction_ws, hit, args.cone_width * hit.distance);
  point.position_ws = surface.position_ws;
  point.normal_ws = surface.normal_ws;
  point.geometric_normal_ws = surface.geometric_normal_ws;
  shaded.material = surface.material;
  if (!surface.front_face && !surface.double_sided && args.back_faces_count == 0u) {
    shaded.flags = kSurfaceDiscounted | kSurfaceReceivesGi;
  } else {
    shaded.flags = surface.receives_gi ? kSurfaceReceivesGi : 0u;
    shaded.radiance = surface.emission;
    float n_dot_v = -dot(surface.normal_ws, ray.direction_ws);
    vec3 albedo = min(effective_albedo(surface.reflectance, n_dot_v), vec3(args.max_albedo));
    shaded.albedo_over_pi = albedo * kInvPi;

    // Ask for the light that may reach it
    if (albedo != vec3(0.0f)) {
      point.random_index = args.first_indices.at[i / args.rays_per_index] + i % args.rays_per_index;
    }
  }
  args.points.at[i] = point;
  args.shaded.at[i] = shaded;
}
