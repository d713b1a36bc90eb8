// SPDX-License-Identifier: Apache-2.0
// What all lights send to a pixel, if nothing is in the way.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/direct_lights.glsl"

void main() {
  ivec2 at = own_pixel();
  if (at.x >= args.width || at.y >= args.rows) return;
  AskingPixel pixel;
  bool asks = find_pixel(at, pixel);
  ReflectedPair sum = ReflectedPair(vec3(0.0f), vec3(0.0f));
  for (int light = 0; asks && light < args.lights; ++light) {
    LightCandidate candidate;
    ReflectedPair pair = sent_light(pixel, uint(light), candidate);
    sum.diffuse += pair.diffuse;
    sum.specular += pair.specular;
  }
  args.direct.at[(args.first_row + at.y) * args.width + at.x] = sum;
}
