// SPDX-License-Identifier: Apache-2.0
// Based on: Kopf et al., "Joint Bilateral Upsampling", SIGGRAPH 2007. Weights of a small picture's
// pixels for a surface of a larger picture.
#ifndef LAMBENT_RSM_UPSAMPLE_H
#define LAMBENT_RSM_UPSAMPLE_H

#include "shared/cross_bilateral.h"

LAMBENT_BEGIN

/// Weight of a pixel that bilinear interpolation does not read, compared to one that it does: it
/// counts where those show other surfaces.
const float kFarWeight = 1e-3f;
/// Sum of weights below which no pixel shows the surface.
const float kLeastUpsampleWeight = 1e-9f;

/// Position of the middle of a pixel in a picture of 1 / downscale of the size [its pixels, from
/// the middle of the first].
LAMBENT_FN vec2 place_in_small_picture(vec2 pixel, float inverse_downscale) {
  return vec2((pixel.x + 0.5f) * inverse_downscale - 0.5f,
              (pixel.y + 0.5f) * inverse_downscale - 0.5f);
}

/// Weight of a pixel for a place, whatever its surface.
LAMBENT_FN float nearness(vec2 place, ivec2 pixel) {
  return max(kFarWeight, 1.0f - abs(place.x - float(pixel.x))) *
         max(kFarWeight, 1.0f - abs(place.y - float(pixel.y)));
}

LAMBENT_END
#endif
