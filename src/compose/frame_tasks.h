// SPDX-License-Identifier: Apache-2.0
// How many pixels of a frame a task works on: enough that handing tasks out costs nothing, and few
// enough that all cores have work to the end.
#pragma once

#include <cstddef>

namespace lambent {

/// Of pixels that cost arithmetic alone.
inline constexpr std::size_t kPixelsPerTask = 4096;
/// Of pixels that cost rays, walks through fog or many lights.
inline constexpr std::size_t kCostlyPixelsPerTask = 1024;

}  // namespace lambent
