// SPDX-License-Identifier: Apache-2.0
// Pearson's chi-squared test of counts against what their densities promise.
#pragma once

#include <cmath>
#include <vector>

namespace lambent::test {

/// Cells that expect fewer counts than this are pooled: the statistic is chi-squared only for large
/// counts.
inline constexpr double kMinExpectedCount = 10.0;

/// The statistic's distance from its mean in standard deviations, after the cube-root transform
/// that makes it normal (Wilson and Hilferty 1931). Right samplers stay below 4 but once in 30,000
/// times.
inline double chi_squared_deviation(const std::vector<double>& observed,
                                    const std::vector<double>& expected) {
  double statistic = 0.0;
  double pooled_observed = 0.0;
  double pooled_expected = 0.0;
  int cells = 0;
  const auto add = [&](double o, double e) {
    statistic += (o - e) * (o - e) / e;
    ++cells;
  };
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] >= kMinExpectedCount) {
      add(observed[i], expected[i]);
    } else {
      pooled_observed += observed[i];
      pooled_expected += expected[i];
    }
  }
  if (pooled_expected >= kMinExpectedCount) {
    add(pooled_observed, pooled_expected);
  } else if (pooled_observed > kMinExpectedCount + 10.0 * std::sqrt(kMinExpectedCount)) {
    return INFINITY;  // samples where there should be next to none
  }
  const double k = cells - 1.0;
  const double spread = 2.0 / (9.0 * k);
  return (std::cbrt(statistic / k) - (1.0 - spread)) / std::sqrt(spread);
}

inline constexpr double kMaxChiSquaredDeviation = 4.0;

}  // namespace lambent::test
