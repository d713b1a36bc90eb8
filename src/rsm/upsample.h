// SPDX-License-Identifier: Apache-2.0
// Based on: Kopf et al., "Joint Bilateral Upsampling", SIGGRAPH 2007. What pixels of a small
// picture count for a surface of a larger one.
#ifndef LAMBENT_RSM_UPSAMPLE_H
#define LAMBENT_RSM_UPSAMPLE_H

#include "shared/cross_bilateral.h"

LAMBENT_BEGIN

/// Weight of a pixel that bilinear interpolation does not ask, beside one that it does: it decides
/// where those show other surfaces.
const float kFarWeight = 1e-3f;
/// Sum of weights below which no pixel shows the surface.
const float kLeastUpsampleWeight = 1e-9f;

/// Where the middle of a pixel lies in a picture of 1 / downscale of the size [its pixels, from the
/// middle of the first].
LAMBENT_FN vec2 place_in_small_picture(vec2 pixel, float inverse_downscale) {
  return vec2((pixel.x + 0.5f) * inverse_downscale - 0.5f,
              (pixel.y + 0.5f) * inverse_downscale - 0.5f);
}

/// What a pixel counts for a place, whatever it shows.
LAMBENT_FN float nearness(vec2 place, ivec2 pixel) {
  return max(kFarWeight, 1.0f - abs(place.x - float(pixel.x))) *
         max(kFarWeight, 1.0f - abs(place.y - float(pixel.y)));
}

LAMBENT_END
#endif
