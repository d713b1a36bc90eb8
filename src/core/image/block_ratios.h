// SPDX-License-Identifier: Apache-2.0
// The distribution of an error over a picture: ratios of block means, and outliers among them.
#pragma once

#include <span>

namespace lambent {

/// Statistics of a picture's block means divided by those of its reference. All are 1 where both
/// are equal, and NaN where no block can be judged.
struct BlockRatios {
  double first_percentile = 1.0;  ///< 1 % of the blocks have a smaller ratio.
  double last_percentile = 1.0;   ///< 1 % of the blocks have a larger ratio.
  /// The smallest and the largest quotient of a block's ratio and the median ratio of the blocks
  /// around it (kSpotRadius): these find dark and bright spots even where the mean is right.
  double darkest_spot = 1.0, brightest_spot = 1.0;
};

/// A block is compared with those up to this many blocks away along both axes.
inline constexpr int kSpotRadius = 2;

/// Blocks whose reference is darker than this fraction of its mean are not judged: the ratio of two
/// numbers close to 0 is meaningless.
inline constexpr double kLeastJudgedLight = 0.05;

/// Computes the ratios from the luminance of blocks, row after row of `columns` blocks. Blocks
/// without a pixel are NaN in both.
BlockRatios block_ratios(std::span<const double> blocks, std::span<const double> reference,
                         int columns);

}  // namespace lambent
