// SPDX-License-Identifier: Apache-2.0
// Temporal accumulation of light: which pixels of the previous frame show the same surface, and how
// frames are weighted.
#ifndef LAMBENT_DENOISE_HISTORY_MATH_H
#define LAMBENT_DENOISE_HISTORY_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Least cosine between normals that are taken for the same surface's: facets of round things are up
// to 25 degrees apart.
const float kSameSurfaceCosine = 0.9f;
// Share of its depth by which a surface may differ from its expected depth.
const float kSameSurfaceDepth = 0.01f;
// Further tolerance of depth: its change over this many pixels of the surface's slope.
const float kSameSurfacePixels = 1.5f;
// Least cosine to the viewer from which that slope is computed.
const float kLeastSlopeCosine = 0.05f;
// Least sum of the bilinear weights of valid pixels; below it there is no history.
const float kLeastHistoryWeight = 0.05f;

/// Pixels of the previous frame, and their weights.
struct HistoryTaps {
  int pixels[4];
  float weights[4];
};

LAMBENT_FN HistoryTaps no_history() {
  HistoryTaps taps;
  for (int k = 0; k < 4; ++k) {
    taps.pixels[k] = 0;
    taps.weights[k] = 0.0f;
  }
  return taps;
}

LAMBENT_FN bool is_history(HistoryTaps taps) {
  return taps.weights[0] + taps.weights[1] + taps.weights[2] + taps.weights[3] > 0.0f;
}

/// Tolerance of a surface's depth [m]. `pixel_width`: width of a pixel at that depth [m]; `cosine`:
/// between the surface's normal and the direction to the viewer.
LAMBENT_FN float depth_tolerance(float depth, float pixel_width, float cosine) {
  float c = max(cosine, kLeastSlopeCosine);
  float slope = sqrt(max(1.0f - c * c, 0.0f)) / c;
  return kSameSurfaceDepth * depth + kSameSurfacePixels * pixel_width * slope;
}

/// Number of frames in an average after this frame; at most `most`.
LAMBENT_FN float averaged_frames(float before, float most) {
  return min(before + 1.0f, most);
}

// Gathered light is averaged as its difference from the lookup, which is wrong once the lookup has
// changed much: a difference from a brighter lookup would leave a dark stain. Where the smaller of
// the lookups before and now is at least kSameLookup of the larger, the average is kept; where it
// is below kOtherLookup, it is discarded.
const float kSameLookup = 0.85f;
const float kOtherLookup = 0.6f;

/// The share of its frames that an average of differences from lookups keeps. `before`: the mean
/// luminance of the lookups in the average; `now`: the luminance of this frame's lookup [W/m^2].
LAMBENT_FN float kept_by_lookup(float before, float now) {
  float greater = max(before, now);
  float ratio = greater > 0.0f ? min(before, now) / greater : 1.0f;
  return clamp((ratio - kOtherLookup) / (kSameLookup - kOtherLookup), 0.0f, 1.0f);
}

// Noise of the change of level of lookups from an average of frames to a frame, as a share. In a
// flat lit by a turning sun, the mean over a third of the picture's height changes by 2 % from
// frame to frame by noise alone, of which a seventh is followed.
const float kLevelNoise = 0.05f;
// An average that would have to change by more than this factor is of other light.
const float kMaxLevelChange = 2.0f;

/// Whether an average of lookups is of other light than this frame's, so that none of it is kept:
/// scaled by kMaxLevelChange alone, it would lag behind. `before`, `now`: luminance of the mean of
/// lookups around, in the average and in this frame [W/m^2].
LAMBENT_FN bool is_other_light(float before, float now) {
  return max(before, now) > kMaxLevelChange * (1.0f + kLevelNoise) * min(before, now);
}

/// The factor by which an average of lookups follows a change of level. `before`, `now`: the mean
/// of lookups around, in the average and in this frame [W/m^2]. `noise`: standard deviation of the
/// logarithm of their ratio x by noise alone. Of x the share x^2 / (x^2 + noise^2) is followed, as
/// a Wiener filter would (Lim and Oppenheim, "Enhancement and Bandwidth Compression of Noisy
/// Speech", Proc. IEEE 1979): hardly any of a change within the noise, and nearly all of a larger
/// one.
LAMBENT_FN float followed_level(float before, float now, float noise) {
  float change =
      clamp(before > 0.0f ? now / before : 1.0f, 1.0f / kMaxLevelChange, kMaxLevelChange);
  float octaves = log2(change);
  float noise_octaves = noise * log2(exp(1.0f));
  float squares = octaves * octaves + noise_octaves * noise_octaves;
  return exp2(octaves * octaves * octaves / squares);
}

// Gathered excess, what a ray brings beyond kBrightestRay times known_level(), comes once in many
// frames and then lights a whole surface. The average gives each frame this weight, from none on: a
// first frame that showed it whole would be a flash, too. In a hall whose lamp hangs 3 cm off a
// surface, a single ray changes the mean irradiance by 40 %, and by 3 % with this weight.
const float kExcessWeight = 1.0f / 32.0f;

/// The average of excess [W/m^2] after this frame. `before`: the previous average, 0 where there is
/// none.
LAMBENT_FN vec3 averaged_excess(vec3 before, vec3 now) {
  return mix(before, now, kExcessWeight);
}

/// Variance of an average of `frames` frames, given that of the previous average and of this frame.
LAMBENT_FN float averaged_variance(float before, float now, float frames) {
  float share = 1.0f / frames;
  return (1.0f - share) * (1.0f - share) * before + share * share * now;
}

LAMBENT_END
#endif
