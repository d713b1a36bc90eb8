// SPDX-License-Identifier: Apache-2.0
// Adds what further rays found to the light of pixels that no ray of a neighbour helps.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/glossy_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  FurtherRaysArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  CoatRay ray = args.coat_rays.at[i];
  if (ray.pdf == 0.0f) return;
  LitPointRecord point = args.points.at[i];
  PixelSurfaceRecord surface = args.surfaces.at[i];
  CoatReceiver at;
  at.lobe = make_coat_lobe(point.position_ws, point.geometric_normal_ws, point.normal_ws,
                           surface.to_viewer_ws, surface.reflectance.alpha);
  at.reflectance =
      coat_under_layers(surface.reflectance, dot(point.normal_ws, surface.to_viewer_ws));
  at.inverse_tolerance = 0.0f;  // of neighbours, which are not asked
  at.own = ray;
  at.density_scale = emitter_density_scale(args.emitter_samples, surface.fluence);
  find_lobe(at);
  vec3 added = further_light(args.own.at[i], reflected_own_ray(at), args.rays);
  args.light.at[i] += vec4(added, 0.0f);
}
