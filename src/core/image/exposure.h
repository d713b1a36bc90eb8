// SPDX-License-Identifier: Apache-2.0
// Automatic exposure of pictures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lambent/image.h"

namespace lambent {

/// A histogram of a picture's luminances, collected by rows, from which the exposure is found even
/// of a picture that does not fit into memory.
class LuminanceHistogram {
 public:
  /// Counts the pixels of an image of linear radiance; black ones and NaN do not count.
  void add(const Image& linear);
  /// Counts the pixels of rows of a frame. The layers albedo, normal, emission and transmission, if
  /// it has them, say what its pixels show: surfaces have an albedo, or, as metals, a normal, and
  /// neither emit nor transmit light. Lamps emit most of what they send; glass transmits; all else
  /// is background.
  void add(const LayeredImage& rows);

  /// The exposure that brings the typical luminance of the picture to mid-grey [stops]; 0 where all
  /// is black. The typical luminance is the log-average of Reinhard et al., "Photographic Tone
  /// Reproduction for Digital Images", 2002, Eq. 1 and 2, with these changes. Surfaces lighter than
  /// mid-grey count with the mean, in stops, of their luminance and that of a mid-grey card in
  /// their place, so that a white room looks white. Each pixel counts as no further from the median
  /// than some stops, so that lamps and black corners do not determine the exposure. The sky and
  /// other background count at most half as much as all surfaces together, so that a landscape
  /// under a wide sky is not dark. What is seen through glass counts as surfaces where it is most
  /// of the picture. Where surfaces far brighter than the typical luminance cover more than a tenth
  /// of the picture, or still brighter lamps a fiftieth, or coloured ones a two-hundredth, the
  /// exposure is up to three and a half stops less.
  float stops() const;

 private:
  static constexpr int kBinsPerStop = 8;
  static constexpr int kMinStop = -64, kMaxStop = 64;  // luminances beyond are in the end bins
  static constexpr std::size_t kBins = (kMaxStop - kMinStop) * kBinsPerStop;
  using Bins = std::array<std::uint64_t, kBins>;
  static std::size_t bin_of(double stops);
  static double stop_of(std::size_t bin);
  /// The luminance [stops] that `pixels` of these pixels reach; the lowest if there are fewer.
  static double bright_stop(const Bins& bins, double pixels);

  // Pixels of surfaces by the luminance as which they count, and by the actual one. All pixels of
  // images without layers are in `counts_`, none in the others.
  Bins counts_{}, surfaces_{};
  Bins lamps_{}, through_glass_{}, background_{};
  Bins colored_lamps_{};  // among the lamps
};

/// The exposure of an image of linear radiance [stops].
float display_stops(const Image& linear);
/// The exposure of a frame's picture [stops]; see LuminanceHistogram::add().
float display_stops(const LayeredImage& frame);

}  // namespace lambent
