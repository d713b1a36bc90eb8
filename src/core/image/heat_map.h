// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/image/metrics.h"
#include "lambent/image.h"

namespace lambent {

/// Relative errors from this size on get the map's darkest colours.
inline constexpr float kHeatMapRange = 0.5f;

/// A picture (sRGB-encoded, three channels) of the differences between `pair.a` and `pair.b`. Left:
/// the luminance of A over that of B, less one, from -50 % (blue: A is darker) over white to +50 %
/// (red). Right: FLIP, 0 to 1, dark to bright. Each has a legend below; pixels that are not finite
/// are magenta. For `display`, see MetricsOptions.
Image heat_map(const ImagePair& pair, bool display);

/// The pictures one below the other, the narrower ones padded.
Image stack(const std::vector<Image>& pictures);

}  // namespace lambent
