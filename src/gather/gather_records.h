// SPDX-License-Identifier: Apache-2.0
// Arguments of the kernels that gather pixels' light on a device.
#ifndef LAMBENT_GATHER_GATHER_RECORDS_H
#define LAMBENT_GATHER_GATHER_RECORDS_H

#include "field/vulkan/device_records.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

/// Rays that gather the light of pixels, `rays_per_pixel` each, and the index of each pixel's first
/// one.
struct GatherRaysArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  RayArray rays;
  UintArray first_indices;
  uint first;        ///< Of the band's pixels.
  uint count;        ///< From there on.
  uint first_pixel;  ///< Of the band.
  uint width;        ///< Of the picture [pixels].
  uint rays_per_pixel;
  uint index;  ///< Of the sample.
  uint seed;
  uint padding;
};

/// Where rays ask the field for light.
struct RayQueriesArguments {
  LitPointArray points;
  RayArray rays;
  QueryArray queries;
  uint count;
  uint padding;
};

/// Irradiance of pixels from what their rays gathered.
struct GatherSumArguments {
  LitPointArray points;        ///< Of the band's pixels,
  PixelSurfaceArray surfaces;  ///< and what these show.
  RayArray rays;
  ShadedHitArray shaded;
  Vec3Array direct;  ///< Irradiance of what the rays met, from lights,
  Vec3Array field;   ///< and from the field.
  Vec3Array irradiance;
  FloatArray variance;  ///< Of its luminance; written where a pixel has more than one ray.
  Vec3Array known;      ///< Irradiance that the field knows; read where keeps_excess is 1.
  Vec3Array excess;     ///< As in GatheredLight; written there.
  uint first;
  uint count;
  uint rays_per_pixel;
  uint keeps_excess;
};

LAMBENT_END
#endif
