// SPDX-License-Identifier: Apache-2.0
// Direct light that points reflect: what arrives, in the order of the slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/vulkan/shading_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CollectArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  vec3 diffuse = vec3(0.0f);
  vec3 specular = vec3(0.0f);
  for (uint slot = 0u; slot < args.slots; ++slot) {
    uint at = slot * args.count + i;
    if (args.occluded.at[at] != 0u) continue;
    diffuse += args.pairs.at[at].diffuse;
    specular += args.pairs.at[at].specular;
  }
  args.diffuse.at[args.first + i] = diffuse;
  args.specular.at[args.first + i] = specular;
}
