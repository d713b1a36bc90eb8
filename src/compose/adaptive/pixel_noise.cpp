// SPDX-License-Identifier: Apache-2.0
#include "compose/adaptive/pixel_noise.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "compose/frame_tasks.h"
#include "core/parallel.h"

namespace lambent {
namespace {

// Standard error of a pixel's mean above which it takes further samples, as a share of the range of
// a display: eight of 255 levels. Grain of less is hardly seen; below half of that, the noise that
// the filter leaves on plain walls would be taken for edges.
constexpr float kVisibleError = 8.0f / 255.0f;

// No sample.
constexpr float kNone = -1.0f;

/// About what a display shows of a luminance, 0 to 1: compressed as by Reinhard et al. 2002, and
/// with a gamma of 2. `middle`: the luminance at which compression halves.
float shown(float luminance, float middle) {
  return std::sqrt(luminance / (luminance + middle));
}

}  // namespace

PixelNoise::PixelNoise(std::size_t width, std::size_t height)
    : width_(width), height_(height), sums_(width * height), last_(width * height, 0.0f) {}

void PixelNoise::add(std::span<const float> luminances, float share,
                     std::span<const std::uint8_t> skipped) {
  std::vector<float>& sample = pending_.emplace_back(luminances.size());
  parallel_chunks(luminances.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const bool has_one = skipped.empty() || skipped[i] == 0;
      // Rounding may make the difference negative
      sample[i] = has_one ? std::max((luminances[i] - last_[i]) / share, 0.0f) : kNone;
      last_[i] = luminances[i];
    }
  });
  if (middle_) count_pending();
}

void PixelNoise::scale(float kept, std::span<const std::uint8_t> skipped) {
  for (std::size_t i = 0; i < last_.size(); ++i) {
    if (skipped[i] == 0) last_[i] *= kept;
  }
}

/// Adds the pending samples to the sums.
void PixelNoise::count_pending() {
  parallel_chunks(sums_.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (const std::vector<float>& sample : pending_) {
      for (std::size_t i = begin; i < end; ++i) {
        if (sample[i] == kNone) continue;
        const float value = shown(sample[i], *middle_);
        sums_[i].sum += value;
        sums_[i].squares += value * value;
        ++sums_[i].count;
      }
    }
  });
  pending_.clear();
}

/// Whether a pixel's mean, as a display shows it, has a visible error by its own samples.
bool PixelNoise::is_noisy(std::size_t pixel) const {
  const Sums& of = sums_[pixel];
  const auto n = static_cast<float>(of.count);
  const float square_error = (of.squares - of.sum * of.sum / n) / (n * std::max(n - 1.0f, 1.0f));
  // Written so that a pixel that is not a number is left alone
  return square_error > kVisibleError * kVisibleError;
}

/// Whether a pixel visibly differs from a neighbour, and one of them has a visible error.
bool PixelNoise::needs_more(std::size_t x, std::size_t y) const {
  bool noisy = false;
  float least = mean(y * width_ + x), most = least;
  for (std::size_t there_y = y - (y > 0); there_y < std::min(y + 2, height_); ++there_y) {
    for (std::size_t there_x = x - (x > 0); there_x < std::min(x + 2, width_); ++there_x) {
      const std::size_t there = there_y * width_ + there_x;
      noisy = noisy || is_noisy(there);
      least = std::min(least, mean(there));
      most = std::max(most, mean(there));
    }
  }
  return noisy && most - least > kVisibleError;
}

void PixelNoise::expose(float stops) {
  middle_ = std::exp2(-stops);
  count_pending();
}

std::size_t PixelNoise::choose(std::span<std::uint8_t> skipped) const {
  std::atomic<std::size_t> chosen = 0;
  parallel_chunks(height_, 1, [&](std::size_t y, std::size_t) {
    std::size_t count = 0;
    for (std::size_t x = 0; x < width_; ++x) {
      std::uint8_t& skips = skipped[y * width_ + x];
      if (skips != 0) continue;
      skips = needs_more(x, y) ? 0 : 1;
      count += 1 - skips;
    }
    chosen += count;
  });
  return chosen;
}

}  // namespace lambent
