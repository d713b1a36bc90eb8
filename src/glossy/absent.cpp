// SPDX-License-Identifier: Apache-2.0
// Without the CPU backend, the sums over neighbouring rays have no implementation on the processor.
#include <stdexcept>

#include "glossy/reuse_lanes.h"

namespace lambent {

void reuse_row(const ReuseRow&, RowPlanes&) {
  throw std::runtime_error("this build of Lambent renders on Vulkan devices alone");
}

}  // namespace lambent
