// SPDX-License-Identifier: Apache-2.0
#include "compose/history/noise_history.h"

#include <algorithm>

#include "denoise/atrous_pass.h"
#include "denoise/history_math.h"

namespace lambent {
namespace {

/// Variance of the averaged light's luminance, from the differences between frames and averages.
float variance_by_frames(const NoiseHistory& last, const AveragedPixel& pixel, NoiseHistory& next) {
  const std::size_t i = pixel.index;
  const float difference = finite_or_dark(pixel.difference);
  float& variance = next.of_frames[i] = difference * difference;
  float& share = next.shares[i] = 1.0f;
  if (is_history(pixel.taps)) {
    // The difference has the variances of the frame and of the average, which has at most this
    // share: interpolation between pixels lowers it
    const float share_before = weighted_sum(last.shares, pixel.taps);
    variance /= 1.0f + share_before;
    // A rare bright sample counts as much in the variance as in the light, or it would stand out.
    // The light's first frame had no difference
    const float weight = pixel.is_changed ? 0.0f : 1.0f / std::max(pixel.frames - 1.0f, 1.0f);
    variance = mix(weighted_sum(last.of_frames, pixel.taps), variance, weight);
    share = averaged_variance(share_before, 1.0f, pixel.frames);
  }
  return variance * share;
}

}  // namespace

void NoiseHistory::resize(std::size_t pixels, bool samples_measure) {
  measured.resize(samples_measure ? pixels : 0);
  const std::size_t by_frames = samples_measure ? 0 : pixels;
  of_frames.resize(by_frames);
  shares.resize(by_frames);
}

void average_noise(const NoiseHistory& last, const AveragedPixel& pixel, const FrameNoise& noise,
                   NoiseHistory& next) {
  const std::size_t i = pixel.index;
  if (next.measured.empty()) {
    const float variance = variance_by_frames(last, pixel, next);
    if (!noise.from_history.empty()) noise.from_history[i] = variance;
    return;
  }
  float& variance = noise.of_samples[i];
  if (pixel.frames > 1.0f) {
    const float before = weighted_sum(last.measured, pixel.taps);
    variance = averaged_variance(before, variance, pixel.frames);
  }
  next.measured[i] = variance;
}

}  // namespace lambent
