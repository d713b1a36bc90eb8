// SPDX-License-Identifier: Apache-2.0
// Samples texels for each pixel, stratified over the light they contribute, and makes rays to them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/gather_pixel.glsl"
#include "rsm/visibility_rays.h"
#include "shared/random.h"

layout(push_constant, scalar) uniform Push {
  VisibilityArguments args;
};

shared uint asking;  // number of this workgroup's pixels that trace rays

/// Counts the rays of the workgroup.
void count_rays(bool asks) {
  if (gl_LocalInvocationIndex == 0u) asking = 0u;
  barrier();
  if (asks) atomicAdd(asking, 1u);
  barrier();
  if (gl_LocalInvocationIndex != 0u || asking == 0u) return;
  atomicAdd(args.ray_count.at[0], asking * uint(args.rays_per_pixel));
}

RsmTexelRecord texel_at(int start, int k) {
  return args.texels.at[start + k];
}

float worth(Pixel pixel, RsmTexelRecord texel) {
  return texel_target(pixel.position_ws, pixel.normal_ws, texel);
}

void main() {
  Pixel pixel;
  ivec2 size = ivec2(args.width, args.height);
  bool exists = find_pixel(args.view, size, own_place(args.first_tile_row), pixel);
  int start = sub_map_of(pixel.at, args.sub_maps) * args.count;
  float total = 0.0f;
  for (int k = 0; exists && k < args.count; ++k) total += worth(pixel, texel_at(start, k));
  count_rays(total > 0.0f);

  RandomStream random =
      make_random_stream(uint(pixel.at.y * size.x + pixel.at.x), kVisibilitySalt, args.seed);
  float shift = next_uniform(random);
  uint first = invocation_index() * uint(args.rays_per_pixel);
  int k = -1;
  float brought = 0.0f;
  RsmTexelRecord texel = texel_at(start, 0);
  for (int i = 0; i < args.rays_per_pixel; ++i) {
    float wanted = drawn_worth(total, i, shift, args.rays_per_pixel);
    while (k < 0 || (k + 1 < args.count && brought <= wanted)) {
      texel = texel_at(start, ++k);
      brought += worth(pixel, texel);
    }
    args.rays.at[first + uint(i)] = ray_to_point(pixel.position_ws, pixel.normal_ws,
                                                 texel.position_ws, total > 0.0f ? args.mask : 0u);
  }
}
