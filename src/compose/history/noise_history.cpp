// SPDX-License-Identifier: Apache-2.0
#include "compose/history/noise_history.h"

#include <algorithm>

namespace lambent {
namespace {

/// Variance of the averaged light's luminance, from how far frames are off their averages.
float variance_by_frames(const NoiseHistory& last, const AveragedPixel& pixel, NoiseHistory& next) {
  const std::size_t i = pixel.index;
  float& variance = next.of_frames[i] = pixel.off * pixel.off;
  float& frames = next.frames[i] = 0.0f;
  float& share = next.shares[i] = 1.0f;
  if (is_history(pixel.taps)) {
    // The difference of a frame from the average before it has the variances of both
    const float share_before = weighted_sum(last.shares, pixel.taps);
    variance /= 1.0f + share_before;
    // A rare bright sample counts as much in the variance as in the light, or it would stand out
    frames = averaged_frames(weighted_sum(last.frames, pixel.taps), pixel.frames);
    variance = mix(weighted_sum(last.of_frames, pixel.taps), variance, 1.0f / frames);
    share = averaged_variance(share_before, 1.0f, pixel.frames);
  }
  return variance * share;
}

}  // namespace

void NoiseHistory::resize(std::size_t pixels, bool samples_measure) {
  measured.resize(samples_measure ? pixels : 0);
  const std::size_t told = samples_measure ? 0 : pixels;
  of_frames.resize(told);
  frames.resize(told);
  shares.resize(told);
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
