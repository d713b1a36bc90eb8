// SPDX-License-Identifier: Apache-2.0
// Draws a direction from the specular lobe of each pixel that traces a ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/shaders/append_path.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CoatRaysArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  args.coat_rays.at[i] = no_coat_ray(infinity());
  bool keeps_mirrored = (args.keeps & kKeepsMirrored) != 0u;
  if (keeps_mirrored) args.mirrored.at[i] = no_mirrored_coat();
  if ((args.keeps & kKeepsMirroredBases) != 0u) {
    args.mirrored_bases.at[i] = no_shown_base();
  }
  PixelSurfaceRecord surface = args.surfaces.at[i];
  uvec2 pixel = uvec2(i % args.width, args.first_row + i / args.width);
  vec2 u;
  if (args.ray > 0u) {
    if (!needs_further_rays(args.own.at[i], surface.reflectance.alpha)) return;
    u = further_coat_uniforms(pixel, args.sample_index, args.ray, args.seed);
  } else {
    if (!traces_coat(surface.reflectance, surface.coat_shares.coat, int(pixel.y), args.sample_index,
                     args.rows)) {
      return;
    }
    u = coat_uniforms(pixel, args.sample_index, args.rows, args.seed);
  }
  LitPointRecord point = args.points.at[i];
  CoatDraw drawn =
      draw_coat_ray(surface.reflectance, make_frame(point.normal_ws), surface.to_viewer_ws, u);
  if (drawn.pdf <= 0.0f) {
    args.coat_rays.at[i].pdf = -1.0f;
    return;
  }
  args.coat_rays.at[i].direction_ws = drawn.direction_ws;
  args.coat_rays.at[i].pdf = drawn.pdf;
  CoatPath path = begin_path(drawn.pdf, surface.reflectance.alpha,
                             first_stage(surface.reflectance.alpha, keeps_mirrored),
                             emitter_density_scale(args.emitter_samples, surface.fluence));
  append_path(args.list, i, path, surface.cone, point, NextRay(drawn.direction_ws, 1.0f));
}
