// SPDX-License-Identifier: Apache-2.0
// Computes the texels of a light's map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/surface_at.glsl"
#include "rsm/vulkan/device_maps.h"
#include "rsm/maps/map_texel.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push {
  MapTexelsArguments args;
};

RsmTexelRecord texel_at(ivec2 place, RayRecord ray, HitRecord hit) {
  if (missed(hit)) return empty_texel();
  // Instances that cast no indirect light still shadow what is behind them
  uint flags = args.scene.at[0].instances.at[hit.instance].flags;
  if ((flags & kInstanceCastsGi) == 0u) return empty_texel();
  float cross_section =
      perpendicular_area(args.projection, texel_middle(place.x, place.y, args.resolution),
                         args.resolution, hit.distance);
  if (!(cross_section > 0.0f)) return empty_texel();
  Footprint footprint = {0.0f, 0u};
  Surface surface = surface_at(args.scene, ray.direction_ws, hit, footprint);
  PunctualSample light =
      sample_punctual(args.scene.at[0].lights.at[args.light], surface.position_ws);
  return lit_texel(surface.position_ws, surface.normal_ws, surface.geometric_normal_ws,
                   surface.reflectance, ray.direction_ws, light.irradiance, cross_section);
}

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID);
  if (place.x >= args.resolution || place.y >= args.resolution) return;
  int i = place.y * args.resolution + place.x;
  args.texels.at[i] = texel_at(place, args.rays.at[i], args.hits.at[i]);
}
