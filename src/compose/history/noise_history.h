// SPDX-License-Identifier: Apache-2.0
// The noise of light that is averaged over frames.
//
// Based on: Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, sec. 4.2, for
// variances from frames in place of neighbours. That keeps two moments, and takes neighbours for
// surfaces seen in fewer than four frames; here, the difference between a frame and the average
// before it is used from the second frame on, and the filter averages it over neighbours.
#pragma once

#include <cstddef>
#include <vector>

#include "compose/history/history_taps.h"

namespace lambent {

/// What frames leave to the next one about the noise of one kind of light, one entry a pixel. Where
/// a pixel has several samples, these measure the variance of their mean, and the variance of the
/// average over frames follows. With one sample, the differences between frames and the averages
/// before them give it. Differences between neighbours would not: where the camera moves, each
/// frame is interpolated between pixels of the one before, so that neighbours have most of their
/// noise in common. A filter that took their differences for all of the noise would preserve the
/// rest of it as mottles.
struct NoiseHistory {
  /// Variance of the averaged light's luminance, from samples; empty for one sample a pixel.
  std::vector<float> measured;
  /// Variance of the luminance of one frame's light, averaged; empty where `measured` is not.
  std::vector<float> of_frames;
  /// Variance of the averaged light over `of_frames`; empty where `measured` is not.
  std::vector<float> shares;

  /// Makes room for this many pixels.
  void resize(std::size_t pixels, bool samples_measure);
};

/// A pixel's light in a frame, against its average before.
struct AveragedPixel {
  std::size_t index;
  const HistoryTaps& taps;
  /// Luminance of the frame's light less that of the average, which is 0 without a history.
  float difference;
  float frames;     ///< Number of frames in the light's average with this one, >= 1.
  bool is_changed;  ///< The world is lit otherwise than before: not all of the difference is noise.
};

/// A frame's variances; see NoisyLight::variance and history_variance.
struct FrameNoise {
  std::vector<float>& of_samples;    ///< Replaced by that of the averages where they are measured.
  std::vector<float>& from_history;  ///< Written unless it is empty.
};

/// Computes the variance of a pixel's averaged light. Of one sample without a history it is its
/// squared luminance, whose mean over neighbours is at least the variance. `next` has the size of
/// this frame.
void average_noise(const NoiseHistory& last, const AveragedPixel& pixel, const FrameNoise& noise,
                   NoiseHistory& next);

}  // namespace lambent
