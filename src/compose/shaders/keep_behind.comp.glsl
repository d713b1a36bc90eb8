// SPDX-License-Identifier: Apache-2.0
// Stores the light of the first opaque surfaces behind glass apart; see Glossy::keep_behind.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/glossy/seen_through_records.h"
#include "compose/pixel_math.h"
#include "glossy/path_math.h"
#include "raytracing/shaders/unoccluded_light.glsl"
#include "shared/variance.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepBehindArguments args;
};

/// Stores the diffuse light of emitters at a pixel.
void keep_emitters(uint k, uint pixel, LitPointRecord point, Reflectance reflectance,
                   vec3 throughput) {
  FilteredEmitter emitter =
      filtered_emitter(reflectance, args.drawn.at[k],
                       unoccluded_light(args.scene, point.position_ws, point.normal_ws));
  args.seen.at[0].emitters.at[pixel] = emitter.light;
  args.seen.at[0].emitter_levels.at[pixel] = emitter.level;
  args.seen.at[0].emitter_albedo.at[pixel] = throughput * emitter.albedo;
  if (args.draws < 2u) return;
  args.seen.at[0].emitter_variance.at[pixel] =
      filtered_variance(emitter, variance_of_sum(emitter.found,
                                                 args.drawn_squares.at[k], args.draws));
}

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  PixelSurfaceRecord surface = args.surfaces.at[k];
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  CoatPath path = args.paths.at[k];
  if (args.has_sky != 0u) args.diffuse.at[k] += args.sky.at[args.count + k];
  if (!reaches_opaque_surface(path, surface.transmission)) {
    if (args.has_sky != 0u) args.diffuse.at[k] += args.sky.at[k];
    if (args.draws > 0u) args.diffuse.at[k] += args.drawn.at[k] + args.drawn_specular.at[k];
    return;
  }
  args.paths.at[k].stage = kStageBehindGlass;
  LitPointRecord point = args.points.at[k];
  uint i = args.pixels.at[k];
  uint pixel = args.first + i;
  args.seen.at[0].depths.at[pixel] = distance(point.position_ws, args.camera_ws);
  args.seen.at[0].positions_ws.at[pixel] = point.position_ws;
  args.seen.at[0].normals_ws.at[pixel] = point.normal_ws;
  float alpha = alpha_behind(surface.reflectance, surface.coat_shares.coat);
  if (alpha > 0.0f) {
    // The distance to what it reflects is known once all its rays have hit something
    args.seen.at[0].coat_lobes.at[pixel] =
        lobe_guide(point.normal_ws, surface.to_viewer_ws, alpha, 0.0f);
  }
  args.seen.at[0].coat_albedo.at[pixel] =
      coat_albedo_behind(path, surface.reflectance, dot(point.normal_ws, surface.to_viewer_ws));
  if (args.gathers != 0u) {
    args.seen.at[0].bases.at[i] =
        shown_base(point.position_ws, point.normal_ws, point.geometric_normal_ws, surface.gi_share,
                   surface.reflectance, surface.to_viewer_ws, point.viewer_distance, path,
                   !has_no_base(surface.reflectance));
    args.surfaces.at[k].flags = surface.flags | kSurfaceGathers;
  }
  if (args.has_sky != 0u) args.coat_rays.at[i].apart += path.throughput * args.sky.at[k];
  if (args.draws == 0u) return;
  args.coat_rays.at[i].apart += path.throughput * args.drawn_specular.at[k];
  keep_emitters(k, pixel, point, surface.reflectance, path.throughput);
}
