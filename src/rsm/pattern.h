// SPDX-License-Identifier: Apache-2.0
// Based on: Dachsbacher and Stamminger, "Reflective Shadow Maps", I3D 2005, sec. 3.2. The disk
// around a pixel's projection in which it samples a map.
#ifndef LAMBENT_RSM_PATTERN_H
#define LAMBENT_RSM_PATTERN_H

#include "rsm/records.h"
#include "shared/constants.h"

LAMBENT_BEGIN

/// A sample of the disk: its position, and the number of texels that it represents.
struct DiskSample {
  vec2 offset;   ///< From the middle [texels].
  float weight;  ///< [texels]
};

/// Sample `index` of `count` in a disk of this radius [texels]. Radii are uniform, so that the
/// density of samples falls with the distance from the middle, and each represents an area in
/// proportion to it: the sum of the weights is the disk's area. (Published: weights in proportion
/// to the squared distance, not normalised.)
LAMBENT_FN DiskSample disk_sample(uint index, uint count, float radius) {
  float share = (float(index) + 0.5f) / float(count);
  float angle = kTwoPi * fract(float(index) * (kGoldenRatio - 1.0f));
  DiskSample result = {vec2(cos(angle), sin(angle)) * (share * radius),
                       kTwoPi * radius * radius * share / float(count)};
  return result;
}

LAMBENT_DEVICE_ARRAY(DiskSampleArray, DiskSample, 4)

/// The texel of a sub-map (column and row of n x n) nearest to a position in the map [texels]; it
/// may be outside.
LAMBENT_FN ivec2 nearest_in_sub_map(vec2 place, ivec2 sub_map, int n) {
  float x = (place.x - 0.5f - float(sub_map.x)) / float(n) + 0.5f;
  float y = (place.y - 0.5f - float(sub_map.y)) / float(n) + 0.5f;
  return ivec2(int(floor(x)), int(floor(y)));
}

/// A texel as a disk sample of weight `weight`: its flux, over pi, is multiplied by the weight, and
/// its softening widened to the part of one of n x n sub-maps that it represents.
LAMBENT_FN RsmTexelRecord weigh_disk_texel(RsmTexelRecord texel, float weight, int n,
                                           float softening) {
  float share = max(1.0f, weight / float(n * n));
  texel.flux = texel.flux * (weight * kInvPi);
  texel.softening = texel.area > 0.0f ? texel.softening * share * softening : 1.0f;
  return texel;
}

LAMBENT_END
#endif
