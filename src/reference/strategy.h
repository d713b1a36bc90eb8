// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lambent::reference {

/// How light from emissive surfaces and environment maps is found. All give the same mean.
enum class Strategy : std::uint8_t {
  combined,  ///< Both of the below, weighted by the power heuristic.
  scatter,   ///< Only by rays that surfaces scatter.
  light,     ///< Only by points drawn on emissive surfaces and directions drawn from the map.
};

}  // namespace lambent::reference
