// SPDX-License-Identifier: Apache-2.0
// Stores the light of emitters on what pixels' mirrors show apart; see
// Glossy::keep_mirrored_emitters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"
#include "raytracing/shaders/unoccluded_light.glsl"
#include "shared/variance.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepMirroredEmittersArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  PixelSurfaceRecord surface = args.surfaces.at[k];
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  args.specular.at[k] += args.drawn_specular.at[k];
  CoatPath path = args.paths.at[k];
  if (!is_in_own_mirror(path, surface.transmission, surface.reflectance)) {
    args.diffuse.at[k] += args.drawn.at[k];
    return;
  }
  LitPointRecord point = args.points.at[k];
  FilteredEmitter emitter =
      filtered_emitter(surface.reflectance, args.drawn.at[k],
                       unoccluded_light(args.scene, point.position_ws, point.normal_ws));
  float variance = 0.0f;
  if (args.draws > 1u) {
    variance = variance_of_sum(emitter.found, args.drawn_squares.at[k],
                               args.draws);
  }
  args.emitters.at[args.pixels.at[k]] =
      mirrored_emitters(point.position_ws, point.normal_ws, emitter, variance, path);
}
