// SPDX-License-Identifier: Apache-2.0
// Times of passes on a device.
#pragma once

#include <string>
#include <vector>

#include "bench/gpu/options.h"
#include "lambent/world.h"

namespace lambent::bench {

struct Row {
  std::string what;
  double value = 0.0;
  std::string unit;
  std::string bar;  ///< The target; empty: none.
};

/// Measures all rows, for a world on a device. Times are medians over frames of the device's
/// timestamps of each pass.
std::vector<Row> measure(const World& world, const Options& options);

}  // namespace lambent::bench
