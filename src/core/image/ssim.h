// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/image.h"

namespace lambent {

/// Structural similarity per pixel, -1 to 1 (1: the same), of one-channel images of range [0, 1].
/// Wang et al. 2004.
Image ssim(const Image& a, const Image& b);

}  // namespace lambent
