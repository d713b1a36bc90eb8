// SPDX-License-Identifier: Apache-2.0
// Adds the light that the hits of specular rays reflect, and appends the paths that go on.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/shaders/append_path.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CoatLightArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  PixelSurfaceRecord surface = args.surfaces.at[k];
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  uint i = args.pixels.at[k];
  LitPointRecord point = args.points.at[k];
  CoatPath path = args.paths.at[k];
  float n_dot_v = dot(point.normal_ws, surface.to_viewer_ws);
  CoatShares shares = surface.coat_shares;
  vec3 light = coats_light(surface.reflectance, n_dot_v, surface.gi_share, shares,
                           args.field.at[2u * k + 1u]);
  if ((surface.flags & kSurfaceGathers) == 0u) {
    light +=
        reflected_indirect(surface.reflectance, n_dot_v, surface.gi_share * args.field.at[2u * k]);
  }
  CoatRay ray = args.coat_rays.at[i];
  add_radiance(path, light, ray);
  add_direct_light(path, args.diffuse.at[k], args.specular.at[k], ray);
  args.coat_rays.at[i] = ray;

  RandomStream random = make_random_stream(args.first_index + i, args.salt, ~args.seed);
  GlassChoice choice = glass_choice(args.first_index + i, args.path_step, args.seed);
  NextRay next = go_on(surface.transmission, surface.reflectance, shares, point.normal_ws,
                       point.geometric_normal_ws, surface.to_viewer_ws,
                       emitter_density_scale(args.emitter_samples, surface.fluence),
                       bounce_of_step(args.path_step), choice, random, path);
  if (path.pdf > 0.0f) append_path(args.next, i, path, surface.cone, point, next);
}
