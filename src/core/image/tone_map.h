// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "lambent/image.h"

namespace lambent {

/// The curve between linear radiance and the display (see shared/tone_map.h).
enum class ToneMap : std::uint32_t { linear = 0, aces = 1, neutral = 2 };

/// "linear", "aces" or "neutral".
std::optional<ToneMap> tone_map_from_name(std::string_view name);

/// How pixels are shown that the edge of something far brighter than white crosses.
enum class Edges : std::uint8_t {
  smooth,       ///< By how much of them it covers, as their neighbours tell: for light.
  as_averaged,  ///< By their value alone, which is white where little is covered: for data.
};

/// The sRGB-encoded picture in [0, 1] that write_png takes. One and two channels become three
/// (grey; the second is dropped), a fourth (alpha) is clamped and kept. NaN shows as black.
Image display_image(const Image& linear, ToneMap tone_map, float exposure_stops,
                    Edges edges = Edges::smooth);

/// The same for `rows` rows of an image from row `first` on, all of them in the image. Reads the
/// rows directly above and below, too.
Image display_rows(const Image& linear, int first, int rows, ToneMap tone_map, float exposure_stops,
                   Edges edges = Edges::smooth);

/// The factor by which colours become radiance that a display shows about unchanged at that
/// exposure: exact for mid-grey, other colours follow the curve. Within 1e-10 to 1e10.
float radiance_of_colors(ToneMap tone_map, float exposure_stops);

}  // namespace lambent
