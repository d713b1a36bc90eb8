// SPDX-License-Identifier: Apache-2.0
// What both sides of the filter know: how pixels lie in memory, a pass's numbers, and how filtered
// light is put together.
#ifndef LAMBENT_DENOISE_ATROUS_PASS_H
#define LAMBENT_DENOISE_ATROUS_PASS_H

#include "shared/color.h"
#include "shared/cross_bilateral.h"
#include "shared/demodulate.h"

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

// Planes of the lobes that reflect the light, if that is what is filtered: struct LobeGuide.
const int kMirrorPlane = 0;
const int kAcrossPlane = 3;
const int kLobeSharpnessPlane = 6;
const int kSeenDistancePlane = 7;
const int kLobePlanes = 8;

// The filter averages over this share of a lobe's own width [GGX alpha, radians]. All passes
// together so have a fifth of the lobe's deviation, and what coats show is blurred as if they were
// 2 % wider: that much roughness nobody sees.
const float kFilteredLobeShare = 0.5f;

// How much less neighbours count whose lobes have another width, by the square of the difference of
// the two sharpnesses over their sum: a roughness that is a tenth higher takes an eighth of the
// weight, and one twice as high nearly all.
const float kWidthSharpness = 4.0f;

// Keeps lobes without sharpness from dividing by zero: far below that of the widest lobe.
const float kLeastLobeSharpness = 1e-6f;

// Least cosine of the angle of incidence by which lobes are stretched: below it they are slivers.
const float kLeastLobeCosine = 1e-3f;

// Contrast that is always taken for noise, in squares of luminance: far below any light, so that
// equal pixels without variance do not divide zero by zero.
const float kLeastContrast = 1e-20f;

// A variance from several pixels is at least this share of the square of their mean: less is the
// rounding of the two of which it is the difference.
const float kLeastVariance = 1e-6f;

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
  uint has_lobes;          ///< 1: lobes reflect the light; 0: it comes from the hemisphere.
};

/// How far light that a lobe reflects may be averaged over pixels.
struct LobeGuide {
  vec3 mirror_ws;  ///< Where the lobe is about densest; unit.
  vec3 across_ws;  ///< Perpendicular to the plane of incidence, as long as the tangent of the angle
                   ///< of incidence: lobes of grazing angles are that much narrower sideways.
  float sharpness;  ///< One over the square of the angle that is averaged over [1/rad^2]; 0: there
                    ///< is no lobe.
  float inverse_distance;  ///< One over the distance to what the lobe sees [1/m].
};

/// `normal_ws` and `to_viewer_ws`: unit. `alpha`: the lobe's GGX width, above 0.
LAMBENT_FN LobeGuide lobe_guide(vec3 normal_ws, vec3 to_viewer_ws, float alpha,
                                float inverse_distance) {
  float cosine = max(dot(normal_ws, to_viewer_ws), kLeastLobeCosine);
  float width = kFilteredLobeShare * alpha;
  LobeGuide guide = {reflect(-to_viewer_ws, normal_ws),
                     cross(normal_ws, to_viewer_ws) * (1.0f / cosine), 1.0f / (width * width),
                     inverse_distance};
  return guide;
}

/// A number, or 0 where it is not finite, which its bits tell: compilers of shaders may take every
/// number for finite.
LAMBENT_FN float finite_or_dark(float value) {
  const uint kExponent = 0x7f800000u;
  return (floatBitsToUint(value) & kExponent) == kExponent ? 0.0f : value;
}

/// Light as the first pass reads it, where channels that are not finite count as dark: the passes
/// would spread them over all pixels that they reach.
LAMBENT_FN vec3 finite_or_dark(vec3 light) {
  return vec3(finite_or_dark(light.x), finite_or_dark(light.y), finite_or_dark(light.z));
}

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
