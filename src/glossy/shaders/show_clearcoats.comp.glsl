// SPDX-License-Identifier: Apache-2.0
// Makes the clearcoats of surfaces their coats, with nothing under them.
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
  args.surfaces.at[i].coat_share = surface.clearcoat_share;
  args.surfaces.at[i].reflectance = clearcoat_alone(layers);
}
