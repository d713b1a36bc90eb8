// SPDX-License-Identifier: Apache-2.0
// Stores the light transmitted through a band's surfaces for the filter; see keep_through().
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/glossy/seen_through_records.h"
#include "compose/pixel_math.h"
#include "compose/shaders/shown_gather.glsl"
#include "glossy/path_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepThroughArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  if (!is_transmissive(surface.transmission)) return;
  uint pixel = args.first + i;
  CoatRay ray = args.coat_rays.at[i];
  vec3 tint = filtered_tint(surface.transmission);
  args.seen.at[0].light.at[pixel] = ray.radiance / tint;
  if (args.long_ways != 0u) {
    args.seen.at[0].long_ways.at[pixel] = ray.mirrored / tint;
    args.seen.at[0].glass_depths.at[pixel] = args.depths.at[pixel];
  } else {
    args.seen.at[0].light.at[pixel] += ray.mirrored / tint;
  }
  args.seen.at[0].emitter_albedo.at[pixel] /= tint;
  if (args.seen.at[0].depths.at[pixel] > 0.0f) {
    vec3 coat_albedo = args.seen.at[0].coat_albedo.at[pixel];
    args.seen.at[0].coats.at[pixel] = ray.apart / coat_albedo;
    args.seen.at[0].coat_albedo.at[pixel] = coat_albedo / tint;
    if (args.seen.at[0].coat_lobes.at[pixel].sharpness > 0.0f) {
      args.seen.at[0].coat_distances.at[pixel] = args.coat_distances.at[i];
    }
    if (args.gathers != 0u) {
      keep_shown_gather(args.seen.at[0].gather, args.seen.at[0].bases.at[i], 1.0f / tint,
                        args.looked_up.at[i], pixel);
    }
  }
  float passed = args.has_fog != 0u ? args.fog.at[i].w : 1.0f;
  args.seen.at[0].albedo.at[pixel] = surface.sample_weight * passed * tint;
  vec3 normal_ws = args.points.at[i].normal_ws;
  SeenLobe lobe = seen_lobe(surface.transmission, normal_ws, surface.to_viewer_ws);
  if (lobe.alpha <= 0.0f) return;
  args.seen.at[0].distances.at[pixel] = ray.distance;
  args.seen.at[0].lobes.at[pixel] = lobe_guide(-normal_ws, lobe.to_viewer_ws, lobe.alpha, 0.0f);
}
