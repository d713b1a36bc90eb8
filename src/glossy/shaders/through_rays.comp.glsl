// SPDX-License-Identifier: Apache-2.0
// Draws a ray through the surface of each pixel whose surface transmits light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/shaders/append_path.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ThroughRaysArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  args.coat_rays.at[i] = no_coat_ray(-1.0f);
  args.coat_distances.at[i] = -1.0f;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if ((surface.flags & kSurfaceMissed) != 0u || !is_transmissive(surface.transmission)) return;
  if (samples_lights_behind(surface.transmission)) {
    args.surfaces.at[i].flags = surface.flags | kSurfaceSamplesBehind;
  }
  LitPointRecord point = args.points.at[i];
  RandomStream random = make_random_stream(args.first_index + i, args.salt, ~args.seed);
  CoatPath path =
      begin_path_through_glass(surface.transmission.alpha,
                               branch_number(args.first_index + i, args.sample_index, args.seed));
  vec2 u = next_uniform2(random);
  NextRay next = extend_through_glass(surface.transmission, surface.reflectance, point.normal_ws,
                                      surface.to_viewer_ws,
                                      emitter_density_scale(args.emitter_samples, surface.fluence),
                                      vec3(u, next_uniform(random)), path);
  if (path.pdf > 0.0f) append_path(args.list, i, path, surface.cone, point, next);
}
