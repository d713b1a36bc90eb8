// SPDX-License-Identifier: Apache-2.0
// Stores the surfaces that pixels' mirrors show, with the light of emitters there; see
// Glossy::keep_mirrored_bases.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"
#include "raytracing/shaders/unoccluded_light.glsl"
#include "shared/variance.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepMirroredBasesArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  PixelSurfaceRecord surface = args.surfaces.at[k];
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  if (args.draws > 0u) args.specular.at[k] += args.drawn_specular.at[k];
  CoatPath path = args.paths.at[k];
  if (!is_in_own_mirror(path, surface.transmission, surface.reflectance)) {
    if (args.draws > 0u) args.diffuse.at[k] += args.drawn.at[k];
    return;
  }
  LitPointRecord point = args.points.at[k];
  ShownBase base =
      shown_base(point.position_ws, point.normal_ws, point.geometric_normal_ws,
                    surface.gi_share, surface.reflectance, surface.to_viewer_ws,
                    point.viewer_distance, path, args.gathers != 0u);
  if (args.gathers != 0u) args.surfaces.at[k].flags = surface.flags | kSurfaceGathers;
  if (args.draws > 0u) {
    FilteredEmitter emitter =
        filtered_emitter(surface.reflectance, args.drawn.at[k],
                         unoccluded_light(args.scene, point.position_ws, point.normal_ws));
    float variance = 0.0f;
    if (args.draws > 1u) {
      variance = variance_of_sum(emitter.found, args.drawn_squares.at[k], args.draws);
    }
    add_emitters(emitter, variance, path, base);
  }
  args.bases.at[args.pixels.at[k]] = base;
}
