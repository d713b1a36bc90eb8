// SPDX-License-Identifier: Apache-2.0
// Stores what the coats that a band's mirrors show reflect, for the filter; see filter_frame.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepMirroredArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first + i;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if ((surface.flags & kSurfaceSkipped) != 0u) {
    args.pixels.at[0].mirrored_albedo.at[pixel] = vec3(0.0f);
    return;
  }
  args.pixels.at[0].mirrored.at[pixel] = vec3(0.0f);
  args.pixels.at[0].mirrored_depths.at[pixel] = 0.0f;
  args.pixels.at[0].mirrored_lobes.at[pixel].sharpness = 0.0f;
  MirroredCoat coat = args.mirrored.at[i];
  if ((surface.flags & kSurfaceMissed) != 0u || coat.alpha <= 0.0f) return;
  float passed = args.has_fog != 0u ? args.fog.at[i].w : 1.0f;
  args.pixels.at[0].mirrored.at[pixel] = coat.light / coat.albedo;
  args.pixels.at[0].mirrored_albedo.at[pixel] = surface.sample_weight * passed * coat.albedo;
  args.pixels.at[0].mirrored_positions_ws.at[pixel] = coat.position_ws;
  args.pixels.at[0].mirrored_normals_ws.at[pixel] = coat.normal_ws;
  args.pixels.at[0].mirrored_depths.at[pixel] =
      -dot(coat.position_ws - args.camera_ws, args.camera_back);
  args.pixels.at[0].mirrored_lobes.at[pixel] =
      lobe_guide(coat.normal_ws, surface.to_viewer_ws, coat.alpha, coat.inverse_seen_distance);
}
