// SPDX-License-Identifier: Apache-2.0
#include "compose/exposure.h"

#include <algorithm>
#include <cmath>

#include "shared/color.h"

namespace lambent {
namespace {

// Reflectance of a photographer's grey card.
constexpr double kMiddleGrey = 0.18;
// Pixels darker than this share of the mean are background, not subject: they say nothing about
// exposure.
constexpr double kSubjectThreshold = 1e-3;
constexpr float kMaxStops = 20.0f;

}  // namespace

float automatic_exposure(const Image& linear) {
  const std::size_t pixels = static_cast<std::size_t>(linear.width) * linear.height;
  const auto luminance_at = [&](std::size_t i) {
    const float* p = &linear.pixels[i * linear.channels];
    const float value = linear.channels >= 3 ? luminance({p[0], p[1], p[2]}) : p[0];
    return std::isfinite(value) ? static_cast<double>(std::max(value, 0.0f)) : 0.0;
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) sum += luminance_at(i);
  const double threshold =
      kSubjectThreshold * sum / static_cast<double>(std::max<std::size_t>(pixels, 1));

  double log_sum = 0.0;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double value = luminance_at(i);
    if (value <= threshold) continue;
    log_sum += std::log(value);
    ++counted;
  }
  if (counted == 0) return 0.0f;
  const double average = std::exp(log_sum / static_cast<double>(counted));
  return std::clamp(static_cast<float>(std::log2(kMiddleGrey / average)), -kMaxStops, kMaxStops);
}

}  // namespace lambent
