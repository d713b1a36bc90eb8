// SPDX-License-Identifier: Apache-2.0
// Adds the light that clearcoats reflect, from rays and from the field.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/glossy_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ClearcoatLightArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  PixelSurfaceRecord coat = args.surfaces.at[i];
  if ((coat.flags & kSurfaceMissed) != 0u) return;
  vec4 by_rays = args.has_rays != 0u ? args.coats.at[i] : vec4(0.0f);
  float n_dot_v = dot(args.points.at[i].normal_ws, coat.to_viewer_ws);
  args.light.at[i] += coat_light(coat.reflectance, n_dot_v, coat.gi_share, by_rays,
                                 args.mirror_irradiance.at[i]);
}
