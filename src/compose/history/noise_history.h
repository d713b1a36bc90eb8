// SPDX-License-Identifier: Apache-2.0
// The noise of light that is averaged over frames.
//
// Based on: Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, sec. 4.2, for
// variances from frames in place of neighbours.
#pragma once

#include <vector>

#include "compose/history/history_taps.h"

namespace lambent {

/// What frames leave to the next one about the noise of one kind of light, one entry a pixel. Where
/// a pixel's samples measure the variance of their mean, that is averaged. Frames of one sample a
/// pixel measure none, and how far each is off the average before it tells. Neighbours do not:
/// where the camera moves, each frame is interpolated between pixels of the one before, so that
/// they have most of their noise in common, and a filter that took their differences for all of the
/// noise would preserve the rest of it as mottles.
struct NoiseHistory {
  /// Variance of the averaged light's luminance from samples; empty where frames tell it.
  std::vector<float> measured;
  std::vector<float> of_frames;  ///< Variance of a single frame's luminance, averaged; else empty.
  std::vector<float> frames;     ///< Number of frames in `of_frames`; 0: that is a bound.
  std::vector<float> shares;     ///< Variance of the averaged light over that of a frame's.

  /// Makes room for this many pixels.
  void resize(std::size_t pixels, bool samples_measure);
};

/// A pixel's light in a frame, against its average before.
struct AveragedPixel {
  std::size_t index;
  const HistoryTaps& taps;
  float off;     ///< Luminance of the frame's light less the average's; without one: of the light.
  float frames;  ///< Number of frames in the light's average with this one.
};

/// A frame's variances; see NoisyLight::variance and history_variance.
struct FrameNoise {
  std::vector<float>& of_samples;    ///< Replaced by that of the averages where they are measured.
  std::vector<float>& from_history;  ///< Written unless it is empty.
};

/// Computes the variance of a pixel's averaged light. Where neither samples nor a history tell it,
/// it is the squared luminance, which is a bound. `next` has the size of this frame.
void average_noise(const NoiseHistory& last, const AveragedPixel& pixel, const FrameNoise& noise,
                   NoiseHistory& next);

}  // namespace lambent
