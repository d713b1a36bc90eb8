// SPDX-License-Identifier: Apache-2.0
// Sums up the light that arrives at a pixel from the lights that it tests, slot after slot.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/direct_place.glsl"

layout(push_constant, scalar) uniform Push {
  DirectSumArguments args;
};

void main() {
  ivec2 at = own_pixel();
  if (at.x >= args.width || at.y >= args.rows) return;
  int i = (args.first_row + at.y) * args.width + at.x;
  ReflectedPair direct = ReflectedPair(vec3(0.0f), vec3(0.0f));
  LightShare share = LightShare(vec3(0.0f), vec3(0.0f));
  if (args.is_first == 0u) {
    if (args.is_shared != 0u) {
      share = args.shares.at[i];
    } else {
      direct = args.direct.at[i];
    }
  }
  for (int slot = 0; slot < args.slots; ++slot) {
    uint place = uint(slot) * invocation_count() + invocation_index();
    ReflectedPair pair = args.pairs.at[place];
    vec3 arrives = args.dims_shadows != 0u ? args.through.at[place]
                                          : vec3(args.occluded.at[place] != 0u ? 0.0f : 1.0f);
    share.sent += pair.diffuse + pair.specular;
    share.arrived += arrives * (pair.diffuse + pair.specular);
    direct.diffuse += arrives * pair.diffuse;
    direct.specular += arrives * pair.specular;
  }
  if (args.is_shared != 0u) {
    args.shares.at[i] = share;
  } else {
    args.direct.at[i] = direct;
  }
}
