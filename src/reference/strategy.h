// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lambent::reference {

/// How light from emissive surfaces and environment maps is sampled. All give the same mean.
enum class Strategy : std::uint8_t {
  combined,  ///< Both of the following, weighted by the power heuristic.
  scatter,   ///< Only by rays that surfaces scatter.
  light,     ///< Only by points sampled on emissive surfaces and directions sampled from the map.
};

}  // namespace lambent::reference
