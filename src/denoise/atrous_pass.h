// SPDX-License-Identifier: Apache-2.0
// Definitions shared by the filter's backends: the memory layout of pixels, a pass's parameters,
// and the sum of filtered light and detail.
#ifndef LAMBENT_DENOISE_ATROUS_PASS_H
#define LAMBENT_DENOISE_ATROUS_PASS_H

#include "shared/color.h"
#include "shared/cross_bilateral.h"
#include "shared/demodulate.h"

LAMBENT_BEGIN

/// Most passes. In the last one, neighbours are 32 pixels apart.
const int kMaxDenoisePasses = 6;
/// Width of the border around a picture, which shows it mirrored: a pass's farthest neighbour.
const int kDenoiseGuard = 1 << (kMaxDenoisePasses - 1);

// Planes of a pixel's light: red, green, blue; then spread and share (see AtrousLight); then the
// base's red, green and blue where there is one.
const int kLightPlane = 0;
const int kSpreadPlane = 3;
const int kSharePlane = 4;
const int kBasePlane = 5;
const int kDenoisePlanes = 8;

// The filter's guide has the planes of shared/cross_bilateral.h and one more: the light's level.
const int kLevelPlane = kGuidePlanes;
const int kDenoiseGuidePlanes = kGuidePlanes + 1;

// Planes of the lobes that reflect the light, for light that lobes reflect; see LobeGuide.
const int kMirrorPlane = 0;
const int kAcrossPlane = 3;
const int kLobeSharpnessPlane = 6;
const int kInverseHitDistancePlane = 7;
const int kLobePlanes = 8;

// Penalty on neighbours whose lobes have another width, times the square of the difference of the
// two sharpnesses over their sum: a roughness that is a tenth higher takes an eighth off the
// weight, and one twice as high nearly all of it.
const float kWidthSharpness = 4.0f;

// Avoids a division by zero for lobes without sharpness: far below that of the widest lobe.
const float kLeastLobeSharpness = 1e-6f;

// Least cosine of the angle of incidence that stretches lobes: below it they are slivers.
const float kLeastLobeCosine = 1e-3f;

// Penalty on a neighbour beyond a step, times the squared sine of the step's slope: a step as high
// as pixels are apart takes nearly all of the weight, the middle of a sphere 20 pixels wide hardly
// any.
const float kStepSharpness = 16.0f;

// Squared distance [m^2] that keeps a step's slope finite where two pixels are at one place.
const float kLeastSquaredDistance = 1e-20f;

// Squared luminance that always counts as noise: far below any light, so that equal pixels without
// variance do not divide zero by zero.
const float kLeastContrast = 1e-20f;

// Least variance from several pixels, as a share of their squared mean: below it, the variance is
// rounding, as it is the difference of the two.
const float kLeastVariance = 1e-6f;

// Largest share of a window that one pixel counts for. Where it has hardly any neighbours, its
// variance is unknown, and the window's estimate is enlarged by at most 1 / (1 - this).
const float kMostKnownShare = 0.98f;

// Fireflies are more than this many times as bright as the second brightest of the pixels around
// them, and their samples' standard error is at least this share of their light: what many samples
// agree on is no firefly, however small. Where one sample of many brought all light, the error is
// as large as the light.
const float kFireflyOverNeighbours = 2.0f;
const float kFireflyNoise = 0.5f;

// Parts of light that are filtered one after the other.
const uint kWholeLight = 0u;
const uint kWithoutFireflies = 1u;
const uint kFirefliesAlone = 2u;

/// The place that a place of a row or a column of `size` pixels shows, up to kDenoiseGuard beyond
/// its ends: it is mirrored about its last pixels. Without neighbours there, each pass would leave
/// a line where they begin to be missing.
LAMBENT_FN int mirrored_place(int place, int size) {
  if (size < 2) return 0;
  int period = 2 * (size - 1);
  int within = (place < 0 ? -place : place) % period;
  return min(within, period - within);
}

/// How far a place is beyond the ends of a row or a column of `size` pixels; 0 within it.
LAMBENT_FN int beyond_ends(int place, int size) {
  return max(max(-place, place - (size - 1)), 0);
}

/// Factor on the share (AtrousLight) of a mirrored neighbour this far beyond the border, in a pass
/// whose neighbours are `apart`. What it shows is shown by another neighbour, too, where it is
/// `apart` beyond: their noise is then the same, and that of their sum not twice that of one, but
/// four times. Nearer to the border it shows what lies about the pixel, with which it has some
/// noise in common. The factor is linear in between, so that no line is seen where neighbours begin
/// to be mirrored; with 1 in place of 2, there is a sixth more noise beside borders.
LAMBENT_FN float mirrored_share(int beyond, int apart) {
  return 1.0f + 2.0f * float(beyond) / float(apart);
}

// Values of AtrousPass::far_lobes: neighbours whose lobes point the same way but, as something is
// near, see different parts of it,
const uint kNoFarLobes = 0u;           // count as far as these parts are the same.
const uint kFarLobes = 1u;             // count as if it were infinitely far.
const uint kFarLobesWithinNoise = 2u;  // count so where light differs by no more than its noise.

/// Parameters of a pass of the filter.
struct AtrousPass {
  int apart;               ///< Distance between neighbours [pixels].
  float normal_sharpness;  ///< See DenoiseSettings.
  float plane_scale;       ///< 1 / DenoiseSettings::plane_tolerance.
  float contrast_scale;    ///< 1 / DenoiseSettings::noise_tolerance^2.
  float lobe_scale;        ///< 1 / DenoiseSettings::lobe_share^2.
  float far_lobe_scale;    ///< 1 / DenoiseSettings::far_lobe_share^2.
  uint geometric;          ///< 1: the light of pixels is not compared.
  uint checks_steps;       ///< 1: neighbours beyond a step count less; see step_before().
  uint ends_estimate;      ///< 1: after this pass, the variance is known from neighbours.
  uint harmonic;           ///< How variances of two pixels are joined; see variance_between().
  uint only_spread;        ///< 1: averages variances alone, and leaves light as it is.
  uint has_base;           ///< 1: there is a base.
  uint has_levels;         ///< 1: light is divided by a level.
  uint has_lobes;          ///< 1: lobes reflect the light; 0: it comes from the hemisphere.
  uint far_lobes;          ///< kNoFarLobes, ...
};

/// Over which neighbours light that a lobe reflects may be averaged.
struct LobeGuide {
  vec3 mirror_ws;  ///< Mirror direction, where the lobe is about densest; unit.
  vec3 across_ws;  ///< Perpendicular to the plane of incidence, as long as the tangent of the angle
                   ///< of incidence: lobes of grazing angles are that much narrower sideways.
  float sharpness;  ///< One over the square of the lobe's GGX width [1/rad^2]; 0: there is no lobe.
  float inverse_distance;  ///< One over the distance to what the lobe shows [1/m].
};

/// `normal_ws` and `to_viewer_ws`: unit. `alpha`: the lobe's GGX width, above 0.
LAMBENT_FN LobeGuide lobe_guide(vec3 normal_ws, vec3 to_viewer_ws, float alpha,
                                float inverse_distance) {
  float cosine = max(dot(normal_ws, to_viewer_ws), kLeastLobeCosine);
  LobeGuide guide = {reflect(-to_viewer_ws, normal_ws),
                     cross(normal_ws, to_viewer_ws) * (1.0f / cosine), 1.0f / (alpha * alpha),
                     inverse_distance};
  return guide;
}

// The bits of a float's exponent. All of them are set in numbers that are not finite.
const uint kFloatExponentBits = 0x7f800000u;

/// A number, or 0 where it is not finite, which its bits tell: compilers of shaders may assume that
/// every number is finite.
LAMBENT_FN float finite_or_dark(float value) {
  return (floatBitsToUint(value) & kFloatExponentBits) == kFloatExponentBits ? 0.0f : value;
}

/// Light as the first pass reads it, where channels that are not finite count as dark: the passes
/// would spread them over all pixels that they reach.
LAMBENT_FN vec3 finite_or_dark(vec3 light) {
  return vec3(finite_or_dark(light.x), finite_or_dark(light.y), finite_or_dark(light.z));
}

/// Initial AtrousLight::spread of a pixel whose variance was not measured.
LAMBENT_FN float unmeasured_spread(vec3 light, vec3 base) {
  float level = luminance(light - base);
  return level * level;
}

/// Filtered light of a pixel, from its filtered light, the filtered base and the pixel's own base,
/// whose detail is added. The detail belongs to light that the filtered light replaces: where that
/// is darker than the base, the detail is scaled down with it.
LAMBENT_FN vec3 with_detail(vec3 light, vec3 filtered_base, vec3 base) {
  vec3 scale = clamp(light / max(filtered_base, vec3(1e-20f)), vec3(0.0f), vec3(1.0f));
  return max(light + scale * (base - filtered_base), vec3(0.0f));
}

LAMBENT_END
#endif
