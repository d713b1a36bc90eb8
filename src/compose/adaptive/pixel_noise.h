// SPDX-License-Identifier: Apache-2.0
// How much the samples of pixels differ, as a display shows them, and which pixels need more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lambent {

/// The samples of a picture's pixels. They are added one after the other; some pixels may have more
/// of them than others.
class PixelNoise {
 public:
  /// Starts a picture.
  PixelNoise(std::size_t width, std::size_t height);

  /// Adds a sample of each pixel that is not skipped. `luminances`: of the picture so far, in which
  /// the sample counts `share`. `skipped`: 1 for each pixel without a sample; empty: all have one.
  void add(std::span<const float> luminances, float share, std::span<const std::uint8_t> skipped);
  /// The picture of pixels that are not skipped was multiplied by `kept`.
  void scale(float kept, std::span<const std::uint8_t> skipped);

  /// Sets the exposure [stops] at which a display shows the samples; once, before `choose`.
  void expose(float stops);
  /// Chooses, among the pixels that are not skipped, those whose mean of samples, as a display
  /// shows it, visibly differs from a neighbour's, and has a visible standard error, or has a
  /// neighbour that has. Samples of a pixel may agree by chance: if its own decided alone, what is
  /// rare would be lost. Marks all others as skipped. `skipped` has an entry for each pixel.
  /// Returns how many are chosen.
  std::size_t choose(std::span<std::uint8_t> skipped) const;

 private:
  void count_pending();
  bool is_noisy(std::size_t pixel) const;
  bool needs_more(std::size_t x, std::size_t y) const;
  float mean(std::size_t pixel) const {
    return sums_[pixel].sum / static_cast<float>(sums_[pixel].count);
  }

  /// Of the samples of a pixel as a display shows them.
  struct Sums {
    float sum = 0.0f, squares = 0.0f;
    std::uint32_t count = 0;
  };
  std::size_t width_, height_;
  std::vector<Sums> sums_;
  std::vector<float> last_;  // luminances of the picture so far
  /// Samples before `expose`, one picture after the other; below 0: none.
  std::vector<std::vector<float>> pending_;
  /// The luminance that a display shows half as bright as it can; none before `expose`.
  std::optional<float> middle_;
};

}  // namespace lambent
