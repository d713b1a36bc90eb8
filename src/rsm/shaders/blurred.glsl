// SPDX-License-Identifier: Apache-2.0
// Functions for the blur of light.
#include "rsm/vulkan/device_passes.h"
#include "shared/color.h"
#include "shared/cross_bilateral.h"
#include "shared/octahedral.h"
#include "shared/packing.h"
#include "shared/reorient_irradiance.h"

/// The data of a pixel that distinguishes its surface from its neighbours'.
struct GuidePixel {
  vec3 position_ws;
  vec3 normal_ws;  // 0 where nothing is seen
  float inverse_depth;
};

GuidePixel guide_pixel(vec4 point, uint normal) {
  GuidePixel pixel = {vec3(point), point.w > 0.0f ? decode_unit_vector(normal) : vec3(0.0f),
                      point.w};
  return pixel;
}

/// Weighted sums over pixels.
struct BlurredLight {
  vec3 light;
  vec3 means;  // R of shared/reorient_irradiance.h
  float weight;
};

BlurredLight start_blur(uvec3 words) {
  BlurredLight sum = {vec3(0.0f), vec3(0.0f), 1.0f};
  for (int c = 0; c < 3; ++c) {
    sum.light[c] = unpack_upper_half(words[c]);
    sum.means[c] = unpack_lower_half(words[c]);
  }
  return sum;
}

/// Adds a neighbour, with the weight of its tap.
void add_blurred(inout BlurredLight sum, GuidePixel here, GuidePixel there, uvec3 words,
                 float tap_weight, float inverse_tolerance) {
  float weight =
      tap_weight * relit_bilateral_weight(here.position_ws - there.position_ws, here.normal_ws,
                                          there.normal_ws, here.inverse_depth * inverse_tolerance);
  for (int c = 0; c < 3; ++c) {
    sum.light[c] += weight * unpack_upper_half(words[c]);
    sum.means[c] += weight * unpack_lower_half(words[c]);
  }
  sum.weight += weight;
}

uvec3 finish_blur(BlurredLight sum) {
  vec3 light = sum.light / sum.weight;
  vec3 means = sum.means / sum.weight;
  return uvec3(pack_upper_halves(light.x, means.x), pack_upper_halves(light.y, means.y),
               pack_upper_halves(light.z, means.z));
}

/// Irradiance of the mean light at the pixel's own normal.
vec3 relit(BlurredLight sum, GuidePixel here) {
  vec3 light = sum.light / sum.weight;
  return light * reoriented_fraction(sum.means / sum.weight, here.normal_ws, luminance(light));
}
