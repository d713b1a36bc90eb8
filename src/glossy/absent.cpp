// SPDX-License-Identifier: Apache-2.0
// Where the library is built without the CPU backend, nothing is worked on in lanes.
#include <stdexcept>

#include "glossy/reuse_lanes.h"

namespace lambent {

void reuse_row(const ReuseRow&, RowPlanes&) {
  throw std::runtime_error("this build of Lambent renders on Vulkan devices alone");
}

}  // namespace lambent
