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

int own, in_field;  // the first texel of the probe's tile in the list and in the field

vec3 fetch_before(int texel) { return args.before.at[own + texel].xyz; }
vec3 fetch_now(int texel) { return args.light.at[in_field + texel].xyz; }
#include "field/probes/tile_light.inl.h"

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= args.count) return;
  const int texels = kIrradianceTexels * kIrradianceTexels;
  own = k * texels;
  in_field = args.probes.at[k] * texels;
  LightChange change = light_change(texels);
  args.changes.at[k] = vec3(change.squares, change.before, change.now);
}
