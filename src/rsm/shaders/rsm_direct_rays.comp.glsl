// SPDX-License-Identifier: Apache-2.0
// Makes shadow rays to the lights that a sub-map's pixels test, and stores their unoccluded light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/direct_lights.glsl"

void main() {
  ivec2 at = own_pixel();
  AskingPixel pixel;
  bool asks = find_pixel(at, pixel);
  int first = sub_map_of(sub_image_of_group(kSubImages), args.sub_maps) * args.per_sub_map +
              args.first_slot;
  bool shared_out = asks && args.is_shared != 0u;
  uint brightest =
      shared_out ? args.brightest.at[(args.first_row + at.y) * args.width + at.x] : kNoLight;
  uint rays = 0u;
  for (int slot = 0; slot < args.slots; ++slot) {
    RayRecord ray = no_ray();
    ReflectedPair pair = ReflectedPair(vec3(0.0f), vec3(0.0f));
    AssignedLight dealt = args.dealt.at[first + slot];
    if (asks && dealt.light != brightest) {
      LightCandidate candidate;
      pair = sent_light(pixel, dealt.light, candidate);
      pair.diffuse *= dealt.weight;
      pair.specular *= dealt.weight;
      if (pair.diffuse + pair.specular != vec3(0.0f)) ray = shadow_ray(pixel.point, candidate);
    }
    uint place = uint(slot) * invocation_count() + invocation_index();
    args.pairs.at[place] = pair;
    args.shadow_rays.at[place] = ray;
    rays += ray.mask != 0u ? 1u : 0u;
  }
  if (rays > 0u) atomicAdd(args.ray_count.at[0], rays);
}
