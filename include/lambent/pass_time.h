// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lambent {

/// Time of one pass of a frame or of an update.
struct PassTime {
  /// The pass's name, the same in every listing: "gbuffer", "direct", "trace", ...
  std::string name;
  double ms = 0.0;  ///< Sum over all its runs [ms].
};

}  // namespace lambent
