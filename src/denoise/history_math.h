// SPDX-License-Identifier: Apache-2.0
// Light averaged over frames: which pixels of the frame before show the same, and what they count.
#ifndef LAMBENT_DENOISE_HISTORY_MATH_H
#define LAMBENT_DENOISE_HISTORY_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Cosine between normals of what is taken for the same surface: facets of round things are up to 25
// degrees apart.
const float kSameSurfaceCosine = 0.9f;
// Share of its depth by which a surface may differ from where it was expected, ...
const float kSameSurfaceDepth = 0.01f;
// ... besides this many pixels along its slope,
const float kSameSurfacePixels = 1.5f;
// which is that of a surface seen at this cosine at most.
const float kLeastSlopeCosine = 0.05f;
// Less than this of the four pixels around a place is no history.
const float kLeastHistoryWeight = 0.05f;

/// Pixels of the frame before, and what they count.
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

/// By how much the depth of a surface may differ [m]. `pixel_width`: of a pixel at that depth [m];
/// `cosine` between the surface's normal and the direction to the viewer.
LAMBENT_FN float depth_tolerance(float depth, float pixel_width, float cosine) {
  float c = max(cosine, kLeastSlopeCosine);
  float slope = sqrt(max(1.0f - c * c, 0.0f)) / c;
  return kSameSurfaceDepth * depth + kSameSurfacePixels * pixel_width * slope;
}

/// Frames that an average holds once this one is added; at most `most`.
LAMBENT_FN float averaged_frames(float before, float most) {
  return min(before + 1.0f, most);
}

/// Variance of an average of so many frames, from that of the average before and of this frame.
LAMBENT_FN float averaged_variance(float before, float now, float frames) {
  float share = 1.0f / frames;
  return (1.0f - share) * (1.0f - share) * before + share * share * now;
}

LAMBENT_END
#endif
