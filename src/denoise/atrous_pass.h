// SPDX-License-Identifier: Apache-2.0
// What both sides of the filter know: how pixels lie in memory, a pass's numbers, and how filtered
// light is put together.
#ifndef LAMBENT_DENOISE_ATROUS_PASS_H
#define LAMBENT_DENOISE_ATROUS_PASS_H

#include "shared/color.h"
#include "shared/cross_bilateral.h"

LAMBENT_BEGIN

/// Most passes: the last one's neighbours are 32 pixels apart.
const int kMaxDenoisePasses = 6;
/// Pixels that see nothing around the picture: the farthest neighbour of a pass.
const int kDenoiseGuard = 1 << (kMaxDenoisePasses - 1);

// Planes of a pixel's light: red, green, blue; then spread and share (struct AtrousLight); then the
// base's red, green, blue where there is one.
const int kLightPlane = 0;
const int kSpreadPlane = 3;
const int kSharePlane = 4;
const int kBasePlane = 5;
const int kDenoisePlanes = 8;

// Planes of the filter's guide besides those of shared/cross_bilateral.h: the light's level.
const int kLevelPlane = kGuidePlanes;
const int kDenoiseGuidePlanes = kGuidePlanes + 1;

// Contrast that is always taken for noise, in squares of luminance: far below any light, so that
// equal pixels without variance do not divide zero by zero.
const float kLeastContrast = 1e-20f;

// Lower levels of light count as this one, so that none divides by zero.
const float kLeastLevel = 1e-30f;

// The share of a window that one pixel has where it has hardly any neighbours. Its variance is then
// not known, and that estimated from the window is enlarged by no more than 1 / (1 - this).
const float kMostKnownShare = 0.98f;

/// A pass of the filter.
struct AtrousPass {
  int apart;               ///< Pixels between neighbours.
  float normal_sharpness;  ///< As in DenoiseSettings.
  float plane_scale;       ///< 1 / DenoiseSettings::plane_tolerance.
  float contrast_scale;    ///< 1 / DenoiseSettings::noise_tolerance^2.
  uint blind;              ///< 1: light itself is not compared.
  uint ends_blind;         ///< 1: the last such pass, after which the variance is known.
  uint measured;           ///< 1: the variance was measured at pixels, not estimated from them.
  uint only_spread;        ///< 1: variances alone are averaged, light stays as it is.
  uint has_base;           ///< 1: there is a base.
  uint has_levels;         ///< 1: the light is given over a level.
};

/// AtrousLight::spread of a pixel before the first pass, where its variance was not measured.
LAMBENT_FN float unmeasured_spread(vec3 light, vec3 base) {
  float level = luminance(light - base);
  return level * level;
}

/// Filtered light of a pixel from the filtered light and the filtered base around it, and the
/// pixel's own base. The base's detail is that of light which the filtered one replaces: where that
/// is darker, its detail is fainter, too.
LAMBENT_FN vec3 with_detail(vec3 light, vec3 filtered_base, vec3 base) {
  vec3 scale = clamp(light / max(filtered_base, vec3(1e-20f)), vec3(0.0f), vec3(1.0f));
  return max(light + scale * (base - filtered_base), vec3(0.0f));
}

LAMBENT_END
#endif
