// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_SHARED_COLOR_H
#define LAMBENT_SHARED_COLOR_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Shares of the linear Rec. 709 primaries in relative luminance (ITU-R BT.709-6, item 3.2).
const float kRedLuminance = 0.2126f;
const float kGreenLuminance = 0.7152f;
const float kBlueLuminance = 0.0722f;

/// Relative luminance of linear Rec. 709.
LAMBENT_FN float luminance(vec3 linear) {
  return dot(linear, vec3(kRedLuminance, kGreenLuminance, kBlueLuminance));
}

/// IEC 61966-2-1 (sRGB) decoding of one channel, 0 to 1.
LAMBENT_FN float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// IEC 61966-2-1 (sRGB) encoding of one channel, 0 to 1.
LAMBENT_FN float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * pow(linear, 1.0f / 2.4f) - 0.055f;
}

LAMBENT_FN vec3 linear_from_srgb(vec3 encoded) {
  return vec3(linear_from_srgb(encoded.x), linear_from_srgb(encoded.y),
              linear_from_srgb(encoded.z));
}

LAMBENT_FN vec3 srgb_from_linear(vec3 linear) {
  return vec3(srgb_from_linear(linear.x), srgb_from_linear(linear.y), srgb_from_linear(linear.z));
}

LAMBENT_END
#endif
