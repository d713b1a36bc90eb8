// SPDX-License-Identifier: Apache-2.0
// Shades the hits of rays, without direct light, and writes the points that receive direct light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/sky.glsl"
#include "raytracing/shaders/surface_at.glsl"
#include "raytracing/solid_sides/solid_sides_math.h"
#include "raytracing/vulkan/shading_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  HitSurfacesArguments args;
};

/// Whether the side that a ray hit bounds solid matter. The twin of SolidSides::is_solid().
bool is_solid_side(HitRecord hit) {
  uint word = args.solid_first_words.at[hit.instance] + solid_sides_word(hit.triangle);
  return bounds_solid(args.solid_words.at[word], hit.triangle, hit.front_face) != 0u;
}

void main() {
  if (gl_GlobalInvocationID.x >= args.count) return;
  uint i = args.first + gl_GlobalInvocationID.x;
  RayRecord ray = args.rays.at[i];
  HitRecord hit = args.hits.at[i];
  LitPointRecord point =
      LitPointRecord(ray.origin_ws, -ray.direction_ws, -ray.direction_ws, kNoDirectLight, 0u,
                     -ray.direction_ws, 0.0f, uintBitsToFloat(kMissedDistanceBits), 1.0f);
  if (missed(hit)) {
    args.points.at[i] = point;
    ShadedHitRecord sky =
        shaded_sky(sky_radiance(args.scene.at[0].environment, ray.direction_ws));
    if (args.has_glass != 0u) sky = seen_through_glass(sky, args.through.at[i], 1.0f, 1.0f);
    args.shaded.at[i] = sky;
    return;
  }

  // Write the surface
  Footprint footprint = {args.cone_width * hit.distance, 0u};
  Surface surface = surface_at(args.scene, ray.direction_ws, hit, footprint);
  point.position_ws = surface.position_ws;
  point.normal_ws = surface.normal_ws;
  point.geometric_normal_ws = surface.geometric_normal_ws;
  point.viewer_distance = hit.distance;
  point.albedo_shape = encode_albedo_shape(surface.reflectance);
  point.mean_normal_length = surface.reflectance.mean_normal_length;
  bool from_inside = args.discounts_solid_sides != 0u && is_solid_side(hit);
  ShadedHitRecord shaded =
      shaded_surface(surface, ray.direction_ws, args.max_albedo, from_inside ? 1u : 0u);

  if (args.has_glass != 0u) {
    // Rays that a pane stopped also stand for those that it let pass
    float weight = 1.0f;
    if (is_transmissive(surface.transmission) && crosses_glass(ray.mask)) {
      weight = weight_of_stopped(straight_share_at(args.scene, hit.instance, hit.triangle,
                                                   hit.barycentrics, hit.front_face != 0u,
                                                   ray.direction_ws));
    }
    shaded = seen_through_glass(shaded, args.through.at[i], weight, args.max_albedo);
  }

  // Mark points that reflect direct light
  if (shaded.albedo_over_pi != vec3(0.0f)) {
    point.random_index = args.first_indices.at[i / args.rays_per_index] + i % args.rays_per_index;
  }
  args.points.at[i] = point;
  args.shaded.at[i] = shaded;
}
