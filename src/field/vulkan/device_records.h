// SPDX-License-Identifier: Apache-2.0
// What a device keeps of a field.
#ifndef LAMBENT_FIELD_VULKAN_DEVICE_RECORDS_H
#define LAMBENT_FIELD_VULKAN_DEVICE_RECORDS_H

#include "field/lookup/lookup_records.h"
#include "raytracing/ray_records.h"

LAMBENT_BEGIN

// Formats of the store's words, in the order of IrradianceFormat and DistanceFormat.
const uint kRgb9e5 = 0u;
const uint kR11g11b10f = 1u;
const uint kIrradianceFloat32 = 2u;
const uint kRg16f = 0u;
const uint kRg32f = 1u;

// What a surfel's ray ended at, as SurfelKind.
const uint kSurfelSurface = 0u;
const uint kSurfelSky = 1u;
const uint kSurfelBackFace = 2u;

/// What one ray met; as struct Surfel.
struct SurfelRecord {
  vec3 position_ws;
  uint material;
  vec3 albedo_over_pi;
  uint normal_ws;
  vec3 light;
  uint geometric_normal_ws;
  uint kind;
  uint receives_gi;
};

/// A lookup that reads nothing: the place of its first texel.
const uint kNoLookup = 0xFFFFFFFFu;

LAMBENT_DEVICE_ARRAY(GridArray, ProbeGrid, 4)
LAMBENT_DEVICE_ARRAY(SurfelArray, SurfelRecord, 4)
LAMBENT_DEVICE_ARRAY(LookupArray, SurfelLookup, 4)
LAMBENT_DEVICE_ARRAY(CornerOffsetsArray, CornerOffsets, 4)

/// The rays of one update. Matrices hold a row a ray, of so many floats that whole blocks of texels
/// fit; rows beyond the rays, up to a whole cluster, are 0.
struct RaySetRecord {
  Vec3Array directions;
  FloatArray irradiance_weights;
  FloatArray distance_weights;
  int rays;
  uint update;
};
LAMBENT_DEVICE_ARRAY(RaySetArray, RaySetRecord, 8)

/// Probes of a list, one after the other, that last traced the same rays: at most as many as a
/// workgroup of the matrix product takes.
struct ProbeBlock {
  int first;
  int count;
  int ray_set;
};
LAMBENT_DEVICE_ARRAY(ProbeBlockArray, ProbeBlock, 4)

/// Where a store's words are.
struct StoreArrays {
  GridArray grids;
  UintArray offsets;
  UintArray irradiance;
  UintArray distance;
};

/// Probes that a pass works on: their indices, and of each the rays that it last traced.
struct ProbeList {
  IntArray probes;
  IntArray ray_sets;
  RaySetArray sets;
};

/// A point to look the field up at; as struct FieldQuery.
struct QueryRecord {
  vec3 position_ws;
  vec3 normal_ws;
  vec3 to_viewer_ws;
};
LAMBENT_DEVICE_ARRAY(QueryArray, QueryRecord, 4)

LAMBENT_END
#endif
