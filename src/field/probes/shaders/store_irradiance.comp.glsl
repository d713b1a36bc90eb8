// SPDX-License-Identifier: Apache-2.0
// Encodes the light of probes into the store, one lane per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/probes/irradiance_encoding.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  StoreIrradianceArguments args;
};

void main() {
  int t = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || t >= kIrradianceTexels * kIrradianceTexels) return;
  if (args.has_changed != 0u && args.changed.at[k] == 0u) return;
  int probe = args.probes.at[k];
  vec3 light = args.light.at[probe * kIrradianceTexels * kIrradianceTexels + t].xyz;
  int width = kIrradianceTexels + 2;
  int index = (probe * width + t / kIrradianceTexels + 1) * width + t % kIrradianceTexels + 1;
  if (words_of_irradiance(kIrradianceFormat) == 3) {
    for (int c = 0; c < 3; ++c) args.words.at[3 * index + c] = floatBitsToUint(light[c]);
    return;
  }
  vec3 u = irradiance_dither(uint(index), args.dither_seed);
  args.words.at[index] = encode_irradiance(kIrradianceFormat, light, u);
}
