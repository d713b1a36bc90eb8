// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/image.h"
#include "shared/lang.h"

namespace lambent {

/// A pixel's colour; grey where the image has one or two channels.
inline vec3 color_at(const Image& image, int x, int y) {
  const bool grey = image.channels < 3;
  const float* in = image.at(x, y);
  return {in[0], in[grey ? 0 : 1], in[grey ? 0 : 2]};
}

}  // namespace lambent
