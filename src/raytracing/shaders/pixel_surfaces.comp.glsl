// SPDX-License-Identifier: Apache-2.0
// Finds the surfaces at the hits of rays that pixels show.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/light_tree.glsl"
#include "raytracing/shaders/sky.glsl"
#include "raytracing/shaders/surface_at.glsl"
#include "raytracing/vulkan/shading_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  PixelSurfacesArguments args;
};

void main() {
  if (gl_GlobalInvocationID.x >= args.count) return;
  uint i = args.first + gl_GlobalInvocationID.x;
  RayRecord ray = args.rays.at[i];
  HitRecord hit = args.hits.at[i];
  LitPointRecord point = LitPointRecord(ray.origin_ws, -ray.direction_ws, -ray.direction_ws,
                                        kNoDirectLight, 0u, vec3(0.0f), 0.0f,
                                        uintBitsToFloat(kMissedDistanceBits), 1.0f);
  PixelSurfaceRecord pixel = PixelSurfaceRecord(
      lambert_reflectance(vec3(0.0f)), vec3(0.0f), -ray.direction_ws, no_transmission(),
      RayCone(0.0f, 0.0f), kSurfaceMissed, 0.0f, CoatShares(0.0f, 0.0f), hit.sample_weight,
      0.0f, 0.0f);
  if (ray.mask == 0u) {
    pixel.flags |= kSurfaceSkipped;
    pixel.sample_weight = 0.0f;
  } else if (missed(hit)) {
    pixel.cone = args.cones.at[i];
    pixel.emission = sky_radiance_in_cone(args.scene.at[0].environment, ray.direction_ws,
                                          args.cones.at[i].spread);
  } else {
    Footprint footprint = {width_at(args.cones.at[i], hit.distance), 1u};
    Surface surface = surface_at(args.scene, ray.direction_ws, hit, footprint);
    point = LitPointRecord(surface.position_ws, surface.normal_ws, surface.geometric_normal_ws,
                           args.first_index + i, 0u, vec3(0.0f), hit.distance,
                           uintBitsToFloat(kMissedDistanceBits),
                           surface.reflectance.mean_normal_length);
    pixel.reflectance = surface.reflectance;
    pixel.emission = surface.emission;
    MaterialRecord material = fetch_material(args.scene, surface.material);
    if (is_unlit(material)) pixel.emission *= args.unlit_radiance;
    pixel.emission_luminance = emission_luminance(material);
    pixel.fluence =
        fluence(SeenLightTree(args.scene, kNoVisibilityRow), surface.position_ws);
    pixel.transmission = surface.transmission;
    pixel.cone = RayCone(footprint.width, args.cones.at[i].spread);
    pixel.flags = 0u;
    pixel.gi_share = surface.gi_share;
    if (args.traces_coats != 0u && surface.gi_share > 0.0f) {
      pixel.coat_shares = pixel_coat_shares(surface.reflectance);
    }
  }
  args.points.at[i] = point;
  args.surfaces.at[i] = pixel;
}
