// SPDX-License-Identifier: Apache-2.0
// Tone mapping: from linear radiance to display colours.
// Based on: Hill, "ACES", in: Pettineo and Hill, BakingLab, 2016 (the fitted RRT and ODT); Khronos
// Group, "Khronos PBR Neutral Tone Mapper", 2024.
#ifndef LAMBENT_SHARED_TONE_MAP_H
#define LAMBENT_SHARED_TONE_MAP_H

#include "shared/color.h"

LAMBENT_BEGIN

// Which curve tone_map() applies.
const uint kToneMapLinear = 0u;  ///< No curve: clipped at 1.
const uint kToneMapAces = 1u;  ///< Film-like contrast and shoulder; bright colours keep their hue.
const uint kToneMapNeutral = 2u;  ///< Preserves base colours up to 0.8; only highlights desaturate.

/// Inputs are clamped to this, far into every shoulder, so that their squares are finite.
const float kToneMapMaxInput = 65504.0f;

LAMBENT_FN float largest_channel(vec3 color) {
  return max(color.x, max(color.y, color.z));
}

/// Hill 2016: one channel of the ACES reference rendering and output transform, as a ratio of
/// quadratics.
LAMBENT_FN float aces_curve(float v) {
  float numerator = v * (v + 0.0245786f) - 0.000090537f;
  float denominator = v * (0.983729f * v + 0.4329510f) + 0.238081f;
  return numerator / denominator;
}

/// Linear Rec. 709 to display-linear Rec. 709. Hill 2016, with both matrices of the fit: into the
/// curve's primaries (with the RRT's desaturation) and out of them.
LAMBENT_FN vec3 tone_map_aces(vec3 linear) {
  float r = aces_curve(dot(linear, vec3(0.59719f, 0.35458f, 0.04823f)));
  float g = aces_curve(dot(linear, vec3(0.07600f, 0.90834f, 0.01566f)));
  float b = aces_curve(dot(linear, vec3(0.02840f, 0.13383f, 0.83777f)));
  vec3 shaped = vec3(r, g, b);
  return vec3(dot(shaped, vec3(1.60475f, -0.53108f, -0.07367f)),
              dot(shaped, vec3(-0.10208f, 1.10813f, -0.00605f)),
              dot(shaped, vec3(-0.00327f, -0.07276f, 1.07602f)));
}

/// Exposed channels above this, 3.5 stops above mid-grey, are past what the curve can tell from
/// each other: an orange flame, a green tube and a red sign would all be white.
const float kHuePeak = 2.0f;
/// Colours of at least this saturation keep their hue in full; greys have none to keep.
const float kHueSaturation = 2.0f / 3.0f;

/// Display-linear Rec. 709 as tone_map_aces(), but bright colours keep their hue: so far as one is
/// saturated, it is shown as if its largest channel were no more than kHuePeak.
LAMBENT_FN vec3 tone_map_aces_with_hue(vec3 linear) {
  float peak = largest_channel(linear);
  if (peak <= kHuePeak) return tone_map_aces(linear);
  float saturation = 1.0f - min(linear.x, min(linear.y, linear.z)) / peak;
  return mix(tone_map_aces(linear), tone_map_aces(linear * (kHuePeak / peak)),
             min(saturation / kHueSaturation, 1.0f));
}

/// Fresnel reflectance of ior 1.5 at normal incidence: the offset that dielectrics add to base
/// colours.
const float kNeutralFresnel = 0.04f;
/// Peaks above this (0.8 less the offset) are compressed.
const float kNeutralStart = 0.8f - 0.04f;
/// How fast compressed highlights turn white.
const float kNeutralDesaturation = 0.15f;

/// Linear Rec. 709 to display-linear Rec. 709. Khronos 2024.
LAMBENT_FN vec3 tone_map_neutral(vec3 linear) {
  // Subtract the dielectric's reflection; near black (under 0.08), follow a parabola so that 0 maps
  // to 0.
  float darkest = min(linear.x, min(linear.y, linear.z));
  float toe = darkest - darkest * darkest / (4.0f * kNeutralFresnel);
  float offset = darkest < 2.0f * kNeutralFresnel ? toe : kNeutralFresnel;
  vec3 color = linear - vec3(offset);
  float peak = largest_channel(color);
  if (peak < kNeutralStart) return color;

  // Compress the peak into [start, 1), then desaturate in proportion to the compression.
  float room = 1.0f - kNeutralStart;
  float new_peak = 1.0f - room * room / (peak + room - kNeutralStart);
  float whiteness = 1.0f - 1.0f / (kNeutralDesaturation * (peak - new_peak) + 1.0f);
  return mix(color * (new_peak / peak), vec3(new_peak), whiteness);
}

/// Display-linear Rec. 709 in [0, 1] for exposed radiance, by the curve kToneMap...
LAMBENT_FN vec3 tone_map(vec3 exposed, uint curve) {
  vec3 color = clamp(exposed, vec3(0.0f), vec3(kToneMapMaxInput));
  if (curve == kToneMapAces) color = tone_map_aces_with_hue(color);
  if (curve == kToneMapNeutral) color = tone_map_neutral(color);
  return clamp(color, vec3(0.0f), vec3(1.0f));
}

LAMBENT_END
#endif
