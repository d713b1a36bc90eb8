// SPDX-License-Identifier: Apache-2.0
// Samples are taken in a few independent passes: stratified within each pass for low noise, and
// independent between passes, so that their differences give the error.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

namespace lambent::reference {

/// Passes of an estimate: enough to know a pixel's error within a quarter, few enough to stratify
/// well.
inline constexpr int kPasses = 8;

inline int pass_count(int samples) {
  return std::min(samples, kPasses);
}

/// Number of samples in pass `pass`. The numbers differ by at most one and sum to `samples`.
inline int samples_of_pass(int samples, int pass) {
  const int passes = pass_count(samples);
  return samples / passes + (pass < samples % passes ? 1 : 0);
}

/// Variance of the mean of `samples` samples taken in passes, given the sum of all and the sum over
/// passes of (sum of pass)^2 / (samples of pass). Infinite for a single pass.
inline glm::dvec3 variance_of_mean(const glm::dvec3& sum, const glm::dvec3& sum_of_squares,
                                   int samples, int passes) {
  if (passes < 2) return glm::dvec3(std::numeric_limits<double>::infinity());
  const double n = samples;
  return glm::max(sum_of_squares - sum * sum / n, glm::dvec3(0.0)) / ((passes - 1.0) * n);
}

}  // namespace lambent::reference
