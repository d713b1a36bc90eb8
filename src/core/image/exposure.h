// SPDX-License-Identifier: Apache-2.0
// The exposure that suits a picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lambent/image.h"

namespace lambent {

/// How often each luminance is in a picture, collected row by row, so that the exposure of a
/// picture that memory does not hold can be found.
class LuminanceHistogram {
 public:
  /// Counts the pixels of an image of linear radiance; black ones, and what is no number, do not
  /// count. `albedo` is that of the surfaces in its pixels, 0 where there is none; null: not known.
  void add(const Image& linear, const Image* albedo = nullptr);

  /// The stops that bring what is typical of the picture to mid-grey; 0 where all is black. Of
  /// surfaces lighter than mid-grey it is half way between what they send and what a mid-grey card
  /// in their place would, by stops: a white room is to look white. The log-average luminance, as
  /// of Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, Eq. 1 and 2,
  /// but each pixel counts as no further from the median than some stops: a lamp in the picture, or
  /// a black corner, does not decide what the rest looks like. Where more than a tenth of the
  /// picture is surfaces far brighter than that, it is up to two stops less.
  float stops() const;

 private:
  static constexpr int kBinsPerStop = 8;
  static constexpr int kMinStop = -64, kMaxStop = 64;  // luminances beyond fall into the end bins
  static constexpr std::size_t kBins = (kMaxStop - kMinStop) * kBinsPerStop;
  static std::size_t bin_of(double stops);
  static double stop_of(std::size_t bin);
  /// The luminance [stops] that so many pixels of surfaces reach; the least where there are fewer.
  double bright_stop(double pixels) const;

  std::array<std::uint64_t, kBins> counts_{};    // stops by which pixels count
  std::array<std::uint64_t, kBins> surfaces_{};  // those of what reflects, as bright as it is
};

/// The exposure of an image of linear radiance [stops].
float display_stops(const Image& linear);
/// The exposure of a frame's picture [stops], by its albedo where it has such a layer.
float display_stops(const LayeredImage& frame);

}  // namespace lambent
