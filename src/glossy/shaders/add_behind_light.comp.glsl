// SPDX-License-Identifier: Apache-2.0
// Adds the light of sources behind rough surfaces to the light of the pixels' rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/glossy_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  AddBehindLightArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  if ((args.surfaces.at[k].flags & kSurfaceSamplesBehind) == 0u) return;
  uint i = args.has_paths != 0u ? args.pixels.at[k] : k;
  vec3 throughput = args.has_paths != 0u ? args.paths.at[k].throughput : vec3(1.0f);
  args.coat_rays.at[i].radiance += throughput * args.light.at[k];
}
