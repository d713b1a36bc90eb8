// SPDX-License-Identifier: Apache-2.0
// Computes the unoccluded light of all lights at a pixel: of the brightest one, for which it makes
// a shadow ray, and of the sum of all others.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/direct_lights.glsl"

void main() {
  ivec2 at = own_pixel();
  AskingPixel pixel;
  bool asks = find_pixel(at, pixel);
  BrightestLight brightest = no_brightest_light();
  ReflectedPair others = ReflectedPair(vec3(0.0f), vec3(0.0f));
  LightCandidate candidate;
  for (int light = 0; asks && light < args.lights; ++light) {
    ReflectedPair pair = sent_light(pixel, uint(light), candidate);
    add_to_others(brightest, uint(light), pair, others);
  }
  RayRecord ray = no_ray();
  if (brightest.light != kNoLight) {
    sent_light(pixel, brightest.light, candidate);
    ray = shadow_ray(pixel.point, candidate);
    atomicAdd(args.ray_count.at[0], 1u);
  }
  args.pairs.at[invocation_index()] = brightest.sent;
  args.shadow_rays.at[invocation_index()] = ray;
  if (at.x >= args.width || at.y >= args.rows) return;
  int i = (args.first_row + at.y) * args.width + at.x;
  args.direct.at[i] = others;
  args.brightest.at[i] = brightest.light;
}
