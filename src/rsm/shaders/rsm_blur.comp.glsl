// SPDX-License-Identifier: Apache-2.0
// The separable cross-bilateral blur: horizontally into shared memory, and from there vertically.
// It blurs each of unit x unit sub-images or, with a unit of 1, the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
#include "rsm/vulkan/device_passes.h"
#include "rsm/shaders/blurred.glsl"
#include "rsm/shaders/sub_image.glsl"

layout(constant_id = 1) const int kRelit = 0;  // 1: the last blur, which writes relit irradiance
layout(push_constant, scalar) uniform Push {
  BlurArguments args;
};

const int kRows = kBlurTile + 2 * kMaxBlurReach;
shared uvec3 across[kRows][kBlurTile];

ivec2 size() {
  return ivec2(args.width, args.height);
}

uvec3 light_at(int place) {
  int plane = mosaic_places(size(), kSubImages);
  return uvec3(args.light.at[place], args.light.at[place + plane],
               args.light.at[place + 2 * plane]);
}

GuidePixel guide_at(int place) {
  return guide_pixel(args.guide.points.at[place], args.guide.normals.at[place]);
}

/// Adds the pixels at all taps to either side along x.
void blur_across(inout BlurredLight sum, GuidePixel here, ivec2 pixel) {
  for (int k = 0; k < 2 * args.tap_count; ++k) {
    int dist = args.distances[k / 2] * args.unit;
    int x = pixel.x + (k % 2 == 0 ? -dist : dist);
    if (x < 0 || x >= args.width) continue;
    int place = mosaic_index(ivec2(x, pixel.y), size(), kSubImages);
    add_blurred(sum, here, guide_at(place), light_at(place), args.weights[k / 2],
                args.inverse_tolerance);
  }
}

/// Adds the pixels at all taps along y, from rows blurred along x; `row`: the pixel's among them.
void blur_along(inout BlurredLight sum, GuidePixel here, ivec2 pixel, int row) {
  for (int k = 0; k < 2 * args.tap_count; ++k) {
    int rows = k % 2 == 0 ? -args.distances[k / 2] : args.distances[k / 2];
    int y = pixel.y + rows * args.unit;
    if (y < 0 || y >= args.height) continue;
    GuidePixel there = guide_at(mosaic_index(ivec2(pixel.x, y), size(), kSubImages));
    add_blurred(sum, here, there, across[row + rows][gl_LocalInvocationID.x], args.weights[k / 2],
                args.inverse_tolerance);
  }
}

void main() {
  ivec2 sub = sub_image_of_group(args.unit);
  ivec2 tile = tile_of_group(args.unit, 0);
  int column = int(gl_LocalInvocationID.x);
  for (int row = int(gl_LocalInvocationID.y); row < kBlurTile + 2 * args.reach; row += kBlurTile) {
    ivec2 pixel = pixel_of_sub_image(sub, tile + ivec2(column, row - args.reach), args.unit);
    if (pixel.x >= args.width || pixel.y < 0 || pixel.y >= args.height) continue;
    int place = mosaic_index(pixel, size(), kSubImages);
    GuidePixel here = guide_at(place);
    BlurredLight sum = start_blur(light_at(place));
    blur_across(sum, here, pixel);
    across[row][column] = finish_blur(sum);
  }
  barrier();

  int row = int(gl_LocalInvocationID.y) + args.reach;
  ivec2 pixel = pixel_of_sub_image(sub, tile + ivec2(gl_LocalInvocationID), args.unit);
  if (pixel.x >= args.width || pixel.y >= args.height) return;
  int place = mosaic_index(pixel, size(), kSubImages);
  GuidePixel here = guide_at(place);
  BlurredLight sum = start_blur(across[row][column]);
  blur_along(sum, here, pixel, row);
  if (kRelit != 0) {
    args.picture.at[pixel.y * args.width + pixel.x] = relit(sum, here);
    return;
  }
  uvec3 words = finish_blur(sum);
  int plane = mosaic_places(size(), kSubImages);
  for (int c = 0; c < 3; ++c) args.blurred.at[place + c * plane] = words[c];
}
