// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lambent::bench {

/// The median of repeated measurements, which a single disturbed repetition does not affect.
class Median {
 public:
  void add(double value) { values_.push_back(value); }

  /// 0 where there are no numbers.
  double value() const {
    if (values_.empty()) return 0.0;
    std::vector<double> sorted = values_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

 private:
  std::vector<double> values_;
};

}  // namespace lambent::bench
