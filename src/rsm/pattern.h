// SPDX-License-Identifier: Apache-2.0
// Based on: Dachsbacher and Stamminger, "Reflective Shadow Maps", I3D 2005, sec. 3.2. The disk
// around a pixel's projection in which it samples a map.
#ifndef LAMBENT_RSM_PATTERN_H
#define LAMBENT_RSM_PATTERN_H

#include "shared/constants.h"

LAMBENT_BEGIN

/// A sample of the disk: where, and how many texels' light it stands for.
struct DiskSample {
  vec2 offset;   ///< From the middle [texels].
  float weight;  ///< [texels]
};

/// Sample `index` of `count` in a disk of that radius [texels]. Radii are uniform, so samples thin
/// out with one over the distance from the middle, and stand for an area in proportion to it: the
/// weights' sum is the disk's area. (Published: weights in proportion to the squared distance, not
/// normalised.)
LAMBENT_FN DiskSample disk_sample(uint index, uint count, float radius) {
  float share = (float(index) + 0.5f) / float(count);
  float angle = kTwoPi * fract(float(index) * (kGoldenRatio - 1.0f));
  DiskSample result = {vec2(cos(angle), sin(angle)) * (share * radius),
                       kTwoPi * radius * radius * share / float(count)};
  return result;
}

LAMBENT_END
#endif
