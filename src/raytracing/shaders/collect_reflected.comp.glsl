// SPDX-License-Identifier: Apache-2.0
// Sums up the direct light that arrives and that points reflect, in the order of the slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/vulkan/shading_records.h"
#include "shared/demodulate.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CollectArguments args;
};

/// The light of a slot that arrives.
ReflectedPair arriving(uint at) {
  if (args.dims_shadows == 0u && args.occluded.at[at] != 0u) {
    return ReflectedPair(vec3(0.0f), vec3(0.0f));
  }
  ReflectedPair pair = args.pairs.at[at];
  if (args.dims_shadows != 0u) {
    vec3 share = args.through.at[at];
    pair.diffuse *= share;
    pair.specular *= share;
  }
  return pair;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  vec3 diffuse = vec3(0.0f);
  vec3 specular = vec3(0.0f);
  vec3 drawn = vec3(0.0f);
  vec3 drawn_specular = vec3(0.0f);
  float squares = 0.0f;
  for (uint slot = 0u; slot < args.slots; ++slot) {
    ReflectedPair pair = arriving(slot * args.count + i);
    if (slot < args.exact_slots) {
      diffuse += pair.diffuse;
      specular += pair.specular;
      continue;
    }
    vec3 albedo = filtered_albedo(args.surfaces.at[args.first + i].reflectance);
    float level = luminance(pair.diffuse / albedo);
    drawn += pair.diffuse;
    drawn_specular += pair.specular;
    squares += level * level;
  }
  if (args.sky_slots != kNoSkySlot) {
    ReflectedPair sky = arriving(args.slots * args.count + i);
    if (args.sky_slots == kAddsSky) {
      specular += sky.specular + sky.diffuse;
    } else {
      args.sky.at[args.first + i] = sky.specular;
      args.sky_in_clearcoats.at[args.first + i] = sky.diffuse;
    }
  }
  args.diffuse.at[args.first + i] = diffuse;
  args.specular.at[args.first + i] = specular;
  if (args.exact_slots < args.slots) {
    args.drawn.at[args.first + i] = drawn;
    args.drawn_squares.at[args.first + i] = squares;
    args.drawn_specular.at[args.first + i] = drawn_specular;
  }
}
