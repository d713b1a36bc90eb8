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
  Vec4Array froxels;  ///< As of FroxelFog::froxels.
  uint media_count;
  uint padding;
};
LAMBENT_DEVICE_ARRAY(FogArray, FogRecord, 8)

/// What fog does to the light of a band's pixels.
struct FogPixelsArguments {
  FogArray fog;
  RayArray rays;    ///< Of the camera, ...
  HitArray hits;    ///< ... and what they met.
  Vec4Array light;  ///< As of fog_along.
  uint width;       ///< Of the picture [pixels].
  uint first_pixel;
  uint count;
  uint index;  ///< Of the sample, of so many:
  uint samples;
  uint seed;
  uint jitter;  ///< As of subpixel_position.
  uint padding;
};

LAMBENT_END
#endif
