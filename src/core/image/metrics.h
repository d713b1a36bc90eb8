// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "core/image/block_ratios.h"
#include "lambent/error.h"
#include "lambent/image.h"

namespace lambent {

struct MetricsOptions {
  /// Side of the blocks [pixels], >= 1, over whose means rmse and related metrics are computed.
  /// Where the reference itself is noisy, 8 hides its noise but preserves structure. SSIM and FLIP
  /// always use single pixels.
  int block = 1;
  double scale = 1.0;  ///< Multiplies A before anything else.
  /// Standard error of B per pixel, of B's shape; null where unknown.
  const Image* standard_error = nullptr;
  /// The images came from display files (PNG, JPEG): white is 1 and nothing is exposed; no
  /// HDR-FLIP.
  bool display = false;
  bool perceptual = true;  ///< false omits ssim and flip (NaN), for layers that are not pictures.
};

/// Differences of image A from reference B. NaN where no pixel can be compared.
struct Metrics {
  std::size_t pixels = 0;             ///< Compared.
  std::size_t excluded = 0;           ///< Left out, because A or B is NaN or infinite there.
  double mean_a = 0.0, mean_b = 0.0;  ///< Over pixels and channels.
  double mean_ratio = 0.0;            ///< mean_a / mean_b.
  double rmse = 0.0;                  ///< Root of the mean square of A - B.
  double relative_rmse = 0.0;         ///< rmse / mean_b.
  /// relative_rmse without the contribution of B's own noise: the mean variance of B is subtracted
  /// from the mean square.
  std::optional<double> noise_corrected_relative_rmse;
  /// Of luminance, over the same blocks as the squared errors.
  BlockRatios blocks;
  double relmse = 0.0;     ///< Mean of (A - B)^2 / (B^2 + kRelMseEpsilon).
  double max_error = 0.0;  ///< The largest |A - B|: shows spots that means hide.
  double peak =
      1.0;  ///< White for PSNR: 1, or the 99.9th percentile of B if that is linear radiance.
  double psnr_db = 0.0;   ///< 20 log10(peak / rmse); infinite for equal images.
  double exposure = 1.0;  ///< Factor that makes linear radiance displayable for ssim and flip; 1
                          ///< for display images.
  double ssim = 0.0;      ///< Mean structural similarity of encoded luminance, 1 when equal.
  double flip = 0.0;      ///< Mean LDR-FLIP of the exposed images, 0 (equal) to 1.
  std::optional<double> hdr_flip;  ///< Mean HDR-FLIP, for linear radiance.
};

/// Keeps relmse finite where B is black. 0.01 is customary (Rousselle et al., "Adaptive Sampling
/// and Reconstruction using Greedy Error Minimization", SIGGRAPH Asia 2011): a tenth of white in
/// terms of B itself.
inline constexpr double kRelMseEpsilon = 0.01;

/// Compares A with B. Alpha (a fourth channel) does not count; one channel compares with three as
/// grey. Fails when sizes or channels do not fit together.
Expected<Metrics> compare_images(const Image& a, const Image& b,
                                 const MetricsOptions& options = {});

/// A and B prepared for metrics: the same number of channels, one to three; A is scaled; pixels
/// that are not finite in either are zero in both.
struct ImagePair {
  Image a, b;
  std::vector<char> valid;  ///< Per pixel: 1 where both are finite.
};
Expected<ImagePair> match_images(const Image& a, const Image& b, double scale);

/// The display-ready linear image (clipped to [0, 1], three channels) at that exposure.
Image clipped_rgb(const Image& image, double exposure);

/// The factor that brings the log-average luminance of `image` to mid-grey; 1 for a black image.
/// Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, Eq. 1 and 2.
double auto_exposure(const Image& image);

}  // namespace lambent
