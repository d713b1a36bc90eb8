// SPDX-License-Identifier: Apache-2.0
#include "core/image/block_ratios.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace lambent {
namespace {

constexpr double kPercentile = 0.01;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The value below which `share` of the values are. Changes the order of the values.
double percentile(std::vector<double>& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

/// The quotient of each block's value in A and in the reference; NaN where it cannot be judged.
std::vector<double> ratios_of(std::span<const double> blocks, std::span<const double> reference) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : reference) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  const double least = count == 0 ? 0.0 : kLeastJudgedLight * sum / static_cast<double>(count);
  std::vector<double> ratios(blocks.size(), kUnknown);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (reference[i] > least) ratios[i] = blocks[i] / reference[i];
  }
  return ratios;
}

/// The median of the known ratios around a block, itself left out; NaN where there is none.
double median_around(std::span<const double> ratios, int columns, int rows, int x, int y) {
  std::vector<double> around;
  for (int v = std::max(0, y - kSpotRadius); v <= std::min(rows - 1, y + kSpotRadius); ++v) {
    for (int u = std::max(0, x - kSpotRadius); u <= std::min(columns - 1, x + kSpotRadius); ++u) {
      const double ratio = ratios[static_cast<std::size_t>(v) * columns + u];
      if ((u != x || v != y) && !std::isnan(ratio)) around.push_back(ratio);
    }
  }
  return around.empty() ? kUnknown : percentile(around, 0.5);
}

}  // namespace

BlockRatios block_ratios(std::span<const double> blocks, std::span<const double> reference,
                         int columns) {
  assert(blocks.size() == reference.size() && columns > 0);
  const std::vector<double> ratios = ratios_of(blocks, reference);
  std::vector<double> known;
  std::copy_if(ratios.begin(), ratios.end(), std::back_inserter(known),
               [](double ratio) { return !std::isnan(ratio); });
  if (known.empty()) return {kUnknown, kUnknown, kUnknown, kUnknown};

  BlockRatios result;
  result.first_percentile = percentile(known, kPercentile);
  result.last_percentile = percentile(known, 1.0 - kPercentile);
  const int rows = static_cast<int>(ratios.size()) / columns;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double around = median_around(ratios, columns, rows, x, y);
      const double spot = ratios[static_cast<std::size_t>(y) * columns + x] / around;
      if (!(around > 0.0) || std::isnan(spot)) continue;
      result.darkest_spot = std::min(result.darkest_spot, spot);
      result.brightest_spot = std::max(result.brightest_spot, spot);
    }
  }
  return result;
}

}  // namespace lambent
