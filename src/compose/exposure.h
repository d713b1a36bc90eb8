// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/image.h"

namespace lambent {

/// Exposure [stops] that brings the picture's log-average luminance to middle grey. 0 for a black picture.
/// Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, Eq. 1 and 2.
float automatic_exposure(const Image& linear);

}  // namespace lambent
