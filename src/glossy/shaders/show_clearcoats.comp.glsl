// SPDX-License-Identifier: Apache-2.0
// Replaces each surface's reflectance by that of its clearcoat alone, so that the specular passes
// can run again for clearcoats.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/glossy_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ShowClearcoatsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  SurfaceLayers layers = surface.reflectance.layers;
  args.points.at[i].normal_ws = clearcoat_normal_ws(layers, args.points.at[i].normal_ws);
  args.surfaces.at[i].coat_shares.coat = surface.coat_shares.clearcoat;
  args.surfaces.at[i].reflectance = clearcoat_alone(layers);
}
