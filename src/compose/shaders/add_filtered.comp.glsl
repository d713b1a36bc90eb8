// SPDX-License-Identifier: Apache-2.0
// Adds filtered light to the layers of the pixels that are shown.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  AddFilteredArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint i = args.first + k;
  PixelLayers layers = args.layers.at[k];
  if (args.emitters != 0u) {
    vec3 direct = args.share * args.pixels.at[0].emitter_albedo.at[i] *
                  args.pixels.at[0].filtered_emitters.at[i];
    layers.direct += direct;
    layers.all += direct;
  }
  if (args.gathered != 0u && args.pixels.at[0].receives.at[i] != 0u) {
    vec3 irradiance = args.share * args.pixels.at[0].filtered_gathered.at[i];
    vec3 indirect = args.pixels.at[0].indirect_albedo.at[i] * irradiance;
    layers.irradiance += irradiance;
    layers.indirect += indirect;
    layers.all += indirect;
  }
  args.layers.at[k] = layers;
}
