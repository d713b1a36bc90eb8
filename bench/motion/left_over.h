// SPDX-License-Identifier: Apache-2.0
// How much of old light later frames still show.
#pragma once

#include "lambent/image.h"

namespace lambent::motion {

/// Frames after which it is measured.
inline constexpr int kAfter = 4;

/// Shares of the old light that are left, over pixels that were bright.
struct Left {
  double mean = 0.0, largest = 0.0;
};

/// For pixels that were much brighter `kAfter` frames ago than they should be now, the ratio of the
/// excess light now to that then. The pictures have one size.
Left left_over(const Image& then, const Image& now, const Image& truth);

}  // namespace lambent::motion
