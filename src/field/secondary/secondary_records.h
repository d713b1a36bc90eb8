// SPDX-License-Identifier: Apache-2.0
// Arguments of the kernels of secondary gathers.
#ifndef LAMBENT_FIELD_SECONDARY_SECONDARY_RECORDS_H
#define LAMBENT_FIELD_SECONDARY_SECONDARY_RECORDS_H

#include "field/vulkan/device_records.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

/// Makes the rays of secondary gathers at the hits of rays, and writes their indices. Gives the
/// queries of these hits a normal of 0, which lookups by rays skip. Others answer them, and
/// secondary_light replaces the answer.
struct SecondaryRaysArguments {
  RayArray rays_before;     ///< The rays at whose hits they start.
  LitPointArray points;     ///< Those hits.
  ShadedHitArray shaded;    ///< Their shading.
  UintArray first_indices;  ///< Index of the first of each `rays_per_index` rays.
  QueryArray queries;       ///< Of the field at those hits.
  GridArray grids;
  RayArray rays;
  UintArray indices;
  UintArray traced;  ///< Number of rays traced so far, where `counts` is 1: one word.
  int volumes;
  uint count;
  uint rays_per_index;
  uint salt;  ///< See gather_salt().
  uint seed;
  uint counts;
};

/// Replaces lookups at the hits of rays by what secondary gathers found there.
struct SecondaryLightArguments {
  LitPointArray points;  ///< Those hits.
  RayArray rays;         ///< Of the secondary gathers, as are the next three.
  ShadedHitArray shaded;
  Vec3Array direct;
  Vec3Array field;
  Vec3Array replaced;  ///< Irradiance from the field at those hits.
  uint count;
  uint padding;
};

LAMBENT_END
#endif
