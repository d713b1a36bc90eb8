// SPDX-License-Identifier: Apache-2.0
// Computes how much the light of probes changed (tile_light.h), one lane per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/probes/shaders/tiles.glsl"
#include "field/probes/tile_light_math.h"
#include "shared/color.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  CompareLightArguments args;
};

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= args.count) return;
  const int texels = kIrradianceTexels * kIrradianceTexels;
  int first = args.probes.at[k] * texels;
  float squares = 0.0;
  float before = 0.0;
  float now = 0.0;
  for (int t = 0; t < texels; ++t) {
    vec3 held = args.before.at[k * texels + t].xyz;
    vec3 holds = args.light.at[first + t].xyz;
    float difference = luminance(holds - held);
    squares += difference * difference;
    before += luminance(held);
    now += luminance(holds);
  }
  before /= float(texels);
  now /= float(texels);
  float mean = max(before, args.darkest);
  float square = mean_relative_square(squares, texels, mean);
  args.changes.at[k] = vec3(square, before, now);
}
