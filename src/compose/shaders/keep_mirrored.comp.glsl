// SPDX-License-Identifier: Apache-2.0
// Stores what the coats that a band's mirrors show reflect, and the light of emitters there, for
// the filter; see keep_pixels.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"

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

void keep_emitters(uint i, uint pixel, PixelSurfaceRecord surface) {
  if ((surface.flags & kSurfaceSkipped) != 0u) {
    args.pixels.at[0].mirrored_emitter_albedo.at[pixel] = vec3(0.0f);
    return;
  }
  args.pixels.at[0].mirrored_emitter_depths.at[pixel] = 0.0f;
  args.pixels.at[0].mirrored_emitter_levels.at[pixel] = 0.0f;
  args.pixels.at[0].mirrored_emitters.at[pixel] = vec3(0.0f);
  if (args.draws > 1u) args.pixels.at[0].mirrored_emitter_variance.at[pixel] = 0.0f;
  MirroredEmitters emitters = args.emitters.at[i];
  if ((surface.flags & kSurfaceMissed) != 0u || emitters.shown == 0u) return;
  vec3 mirror_ws = args.points.at[i].position_ws;
  args.pixels.at[0].mirrored_emitter_depths.at[pixel] =
      view_depth(mirror_ws) + distance(mirror_ws, emitters.position_ws);
  args.pixels.at[0].mirrored_emitter_positions_ws.at[pixel] = emitters.position_ws;
  args.pixels.at[0].mirrored_emitter_normals_ws.at[pixel] = emitters.normal_ws;
  args.pixels.at[0].mirrored_emitters.at[pixel] = emitters.light;
  args.pixels.at[0].mirrored_emitter_levels.at[pixel] = emitters.level;
  args.pixels.at[0].mirrored_emitter_albedo.at[pixel] =
      shown_weight(i, surface) * emitters.albedo * args.mirrored.at[i].mirror_share;
  if (args.draws < 2u) return;
  args.pixels.at[0].mirrored_emitter_variance.at[pixel] = emitters.variance;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first + i;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if (args.draws > 0u) keep_emitters(i, pixel, surface);
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
