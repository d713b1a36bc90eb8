// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/image.h"

namespace lambent {

/// Pixels per degree of the viewer's field of vision: 0.7 m in front of a display of 3,840 pixels
/// on 0.7 m, the setting of both FLIP papers.
inline constexpr float kFlipPixelsPerDegree = 67.0206f;

/// The difference that a person sees when flipping between two display images, per pixel, 0 to 1,
/// one channel. Both are linear Rec. 709 in [0, 1], three channels, of one size. Andersson et al.
/// 2020 (LDR-FLIP).
Image flip(const Image& test, const Image& reference,
           float pixels_per_degree = kFlipPixelsPerDegree);

/// The difference for linear radiance of any range: the largest LDR-FLIP over the exposures at
/// which the reference shows its lights and its shadows. Andersson et al. 2021 (HDR-FLIP). Costs
/// one flip() per stop between them.
Image hdr_flip(const Image& test, const Image& reference,
               float pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace lambent
