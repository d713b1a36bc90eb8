// SPDX-License-Identifier: Apache-2.0
// Stores what the coats that a band's mirrors show reflect, and the light of the surfaces there,
// for the filter; see keep_pixels.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"
#include "compose/shaders/shown_gather.glsl"
#include "glossy/glossy_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepMirroredArguments args;
};

/// The part of the camera's radiance that a pixel's surface sends.
float shown_weight(uint i, PixelSurfaceRecord surface) {
  return surface.sample_weight * (args.has_fog != 0u ? args.fog.at[i].w : 1.0f);
}

float view_depth(vec3 position_ws) {
  return -dot(position_ws - args.camera_ws, args.camera_back);
}

void keep_base(uint i, uint pixel, PixelSurfaceRecord surface) {
  FilteredPixelsRecord kept = args.pixels.at[0];
  bool gathers = (args.keeps & kGathersInMirrors) != 0u;
  kept.mirrored_emitter_albedo.at[pixel] = vec3(0.0f);
  if (gathers) kept.mirrored_gather.albedo.at[pixel] = vec3(0.0f);
  if ((surface.flags & kSurfaceSkipped) != 0u) return;
  kept.mirrored_base_depths.at[pixel] = 0.0f;
  kept.mirrored_emitter_levels.at[pixel] = 0.0f;
  kept.mirrored_emitters.at[pixel] = vec3(0.0f);
  if (args.draws > 1u) kept.mirrored_emitter_variance.at[pixel] = 0.0f;
  ShownBase base = args.bases.at[i];
  vec3 weight = shown_weight(i, surface) * args.mirrored.at[i].mirror_share;
  if (gathers) {
    keep_shown_gather(kept.mirrored_gather, base, weight, args.looked_up.at[i], pixel);
  }
  if ((surface.flags & kSurfaceMissed) != 0u || base.shown == 0u) return;
  vec3 mirror_ws = args.points.at[i].position_ws;
  kept.mirrored_base_depths.at[pixel] =
      view_depth(mirror_ws) + distance(mirror_ws, base.position_ws);
  kept.mirrored_base_positions_ws.at[pixel] = base.position_ws;
  kept.mirrored_base_normals_ws.at[pixel] = base.normal_ws;
  kept.mirrored_emitters.at[pixel] = base.light;
  kept.mirrored_emitter_levels.at[pixel] = base.level;
  kept.mirrored_emitter_albedo.at[pixel] = weight * base.emitter_albedo;
  if (args.draws > 1u) kept.mirrored_emitter_variance.at[pixel] = base.variance;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first + i;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if ((args.keeps & kKeepsMirroredBases) != 0u) keep_base(i, pixel, surface);
  if ((surface.flags & kSurfaceSkipped) != 0u) {
    args.pixels.at[0].mirrored_albedo.at[pixel] = vec3(0.0f);
    return;
  }
  args.pixels.at[0].mirrored.at[pixel] = vec3(0.0f);
  args.pixels.at[0].mirrored_depths.at[pixel] = 0.0f;
  args.pixels.at[0].mirrored_lobes.at[pixel].sharpness = 0.0f;
  MirroredCoat coat = args.mirrored.at[i];
  if ((surface.flags & kSurfaceMissed) != 0u || coat.alpha <= 0.0f) return;
  args.pixels.at[0].mirrored.at[pixel] = coat.light / coat.albedo;
  args.pixels.at[0].mirrored_albedo.at[pixel] = shown_weight(i, surface) * coat.albedo;
  args.pixels.at[0].mirrored_positions_ws.at[pixel] = coat.position_ws;
  args.pixels.at[0].mirrored_normals_ws.at[pixel] = coat.normal_ws;
  args.pixels.at[0].mirrored_depths.at[pixel] = view_depth(coat.position_ws);
  args.pixels.at[0].mirrored_lobes.at[pixel] =
      lobe_guide(coat.normal_ws, surface.to_viewer_ws, coat.alpha, coat.inverse_seen_distance);
}
