// SPDX-License-Identifier: Apache-2.0
// Fog in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_FOG_FOG_RECORDS_H
#define LAMBENT_FOG_FOG_RECORDS_H

#include "fog/froxels.h"

LAMBENT_BEGIN

/// A picture's froxels, and the fog in them.
struct FogRecord {
  FroxelGrid grid;
  MediumArray media;
  Vec4Array froxels;  ///< See FroxelFog::froxels().
  uint media_count;
  uint padding;
};
LAMBENT_DEVICE_ARRAY(FogArray, FogRecord, 8)

/// Computes the effect of fog on a band's pixels.
struct FogPixelsArguments {
  FogArray fog;
  RayArray rays;    ///< The camera's rays.
  HitArray hits;    ///< Their hits.
  Vec4Array light;  ///< Results of fog_along().
  uint width;       ///< Width of the picture [pixels].
  uint first_pixel;
  uint count;
  uint index;  ///< Index of the sample, below `samples`.
  uint samples;
  uint seed;
  uint jitter;  ///< See subpixel_position().
  uint padding;
};

LAMBENT_END
#endif
