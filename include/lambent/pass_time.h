// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lambent {

/// Time of one pass of a frame or of an update.
struct PassTime {
  std::string name;  ///< The pass's name wherever it appears: "gbuffer", "direct", "trace", ...
  double ms = 0.0;   ///< Summed over all times that it ran.
};

}  // namespace lambent
