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
// How much of the way an exposure goes from that of a camera, which shows snow as grey, to that of
// a meter held into the scene's light, which shows snow as white as it is. All of the way would
// leave white walls no room for highlights. Dark surfaces stay as a camera shows them: a street at
// night is dark enough.
constexpr double kAlbedoShare = 0.5;

/// The stops by which a surface of this albedo counts as darker than it is.
double albedo_stops(const float* albedo) {
  const auto level = static_cast<double>(luminance(vec3(albedo[0], albedo[1], albedo[2])));
  return level > kMidGrey ? kAlbedoShare * std::log2(level / kMidGrey) : 0.0;
}

}  // namespace

void LuminanceHistogram::add(const Image& linear, const Image* albedo) {
  const bool grey = linear.channels < 3;
  if (albedo != nullptr && albedo->channels < 3) albedo = nullptr;
  for (int y = 0; y < linear.height; ++y) {
    for (int x = 0; x < linear.width; ++x) {
      const float* in = linear.at(x, y);
      const float value = luminance(vec3(in[0], in[grey ? 0 : 1], in[grey ? 0 : 2]));
      if (!(value > 0.0f) || !std::isfinite(value)) continue;
      double stops = std::log2(static_cast<double>(value));
      if (albedo != nullptr) stops -= albedo_stops(albedo->at(x, y));
      const double bin = (stops - kMinStop) * kBinsPerStop;
      ++counts_[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))];
    }
  }
}

float LuminanceHistogram::stops() const {
  std::uint64_t total = 0;
  for (const std::uint64_t count : counts_) total += count;
  if (total == 0) return 0.0f;
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
  return static_cast<float>(std::log2(kMidGrey) - sum / static_cast<double>(total));
}

float display_stops(const Image& linear) {
  LuminanceHistogram histogram;
  histogram.add(linear);
  return histogram.stops();
}

float display_stops(const LayeredImage& frame) {
  LuminanceHistogram histogram;
  histogram.add(*frame.find(""), frame.find("albedo"));
  return histogram.stops();
}

}  // namespace lambent
