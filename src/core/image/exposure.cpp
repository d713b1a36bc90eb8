// SPDX-License-Identifier: Apache-2.0
#include "core/image/exposure.h"

#include <algorithm>
#include <cmath>

#include "shared/color.h"

namespace lambent {
namespace {

constexpr double kMidGrey = 0.18;
// Pixels count as at most so much darker or brighter than the median [stops]: the range that a
// display shows around mid-grey.
constexpr double kDarker = 5.0, kBrighter = 3.0;

}  // namespace

void LuminanceHistogram::add(const Image& linear) {
  const bool grey = linear.channels < 3;
  for (int y = 0; y < linear.height; ++y) {
    for (int x = 0; x < linear.width; ++x) {
      const float* in = linear.at(x, y);
      const float value = luminance(vec3(in[0], in[grey ? 0 : 1], in[grey ? 0 : 2]));
      if (!(value > 0.0f) || !std::isfinite(value)) continue;
      const double bin = (std::log2(static_cast<double>(value)) - kMinStop) * kBinsPerStop;
      ++counts_[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))];
    }
  }
}

double LuminanceHistogram::exposure() const {
  std::uint64_t total = 0;
  for (const std::uint64_t count : counts_) total += count;
  if (total == 0) return 1.0;
  const auto stop_of = [](std::size_t bin) {
    return kMinStop + (static_cast<double>(bin) + 0.5) / kBinsPerStop;
  };
  std::size_t median = 0;
  for (std::uint64_t below = counts_[0]; 2 * below < total; below += counts_[median]) ++median;

  const double low = stop_of(median) - kDarker, high = stop_of(median) + kBrighter;
  double sum = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    sum += static_cast<double>(counts_[bin]) * std::clamp(stop_of(bin), low, high);
  }
  return kMidGrey / std::exp2(sum / static_cast<double>(total));
}

double display_exposure(const Image& linear) {
  LuminanceHistogram histogram;
  histogram.add(linear);
  return histogram.exposure();
}

}  // namespace lambent
