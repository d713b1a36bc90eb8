// SPDX-License-Identifier: Apache-2.0
// Based on: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to
// Structural Similarity", IEEE Transactions on Image Processing 13(4), 2004.
#include "core/image/ssim.h"

#include <cassert>

#include "core/image/convolve.h"

namespace lambent {
namespace {

/// Sec. III-C: an 11x11 window of standard deviation 1.5 pixels.
constexpr int kWindowRadius = 5;
constexpr float kWindowSigma = 1.5f;
/// Sec. III-C: C1 = (K1 L)^2 and C2 = (K2 L)^2 avoid a division by 0 in flat and dark windows; the
/// range L is 1.
constexpr float kC1 = 0.01f * 0.01f;
constexpr float kC2 = 0.03f * 0.03f;

}  // namespace

Image ssim(const Image& a, const Image& b) {
  assert(a.channels == 1 && b.channels == 1);
  assert(a.width == b.width && a.height == b.height);
  // Filter the moments of both at once: a, b, a^2, b^2, a b.
  constexpr int kMoments = 5;
  Image moments(a.width, a.height, kMoments);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const float va = a.pixels[i], vb = b.pixels[i];
    const float values[kMoments] = {va, vb, va * va, vb * vb, va * vb};
    for (std::size_t m = 0; m < kMoments; ++m) moments.pixels[i * kMoments + m] = values[m];
  }
  const Kernel window = gaussian_kernel(kWindowSigma, kWindowRadius);
  moments = convolve(moments, window, window);

  Image result(a.width, a.height, 1);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const float* m = moments.pixels.data() + i * kMoments;
    const float variance_a = m[2] - m[0] * m[0];
    const float variance_b = m[3] - m[1] * m[1];
    const float covariance = m[4] - m[0] * m[1];
    // Eq. 13: luminance times contrast and structure.
    result.pixels[i] = (2.0f * m[0] * m[1] + kC1) * (2.0f * covariance + kC2) /
                       ((m[0] * m[0] + m[1] * m[1] + kC1) * (variance_a + variance_b + kC2));
  }
  return result;
}

}  // namespace lambent
