// SPDX-License-Identifier: Apache-2.0
// Arguments of the kernels that gather pixels' light on a device.
#ifndef LAMBENT_GATHER_GATHER_RECORDS_H
#define LAMBENT_GATHER_GATHER_RECORDS_H

#include "field/vulkan/device_records.h"
#include "gather/guide_math.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

LAMBENT_DEVICE_ARRAY(GuidePointArray, GuidePoint, 4)

/// Makes the rays that gather the light of pixels, `rays_per_pixel` each, and writes the index of
/// each pixel's first one.
struct GatherRaysArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  RayArray rays;
  UintArray first_indices;
  UintArray guided;       ///< Number of each pixel's guided rays, which are its first.
  FloatArray weights;     ///< Factors of the rays' contributions.
  GuidePointArray guide;  ///< The pilot's points; see GatherGuide.
  Vec3Array places;       ///< And their bright places.
  GuideSize size;
  uint first;        ///< First of these pixels in the band.
  uint count;        ///< Number of pixels.
  uint first_pixel;  ///< The band's first pixel in the picture.
  uint rays_per_pixel;
  uint index;  ///< Index of the sample.
  uint seed;
};

/// Computes the irradiance of pixels from what their rays gathered.
struct GatherSumArguments {
  LitPointArray points;        ///< One for each pixel of the band.
  PixelSurfaceArray surfaces;  ///< One for each pixel of the band.
  RayArray rays;
  UintArray guided;    ///< See GatherRaysArguments.
  FloatArray weights;  ///< Factors of the rays' contributions.
  ShadedHitArray shaded;
  Vec3Array direct;  ///< Irradiance at the rays' hits from lights.
  Vec3Array field;   ///< Irradiance at the rays' hits from the field.
  Vec3Array irradiance;
  FloatArray variance;  ///< Variance of its luminance; written where a pixel has several rays.
  Vec3Array known;      ///< Irradiance from lookups of the field; read where keeps_excess is 1.
  Vec3Array excess;     ///< See GatheredLight; written where keeps_excess is 1.
  uint first;
  uint count;
  uint rays_per_pixel;
  uint keeps_excess;
};

LAMBENT_END
#endif
