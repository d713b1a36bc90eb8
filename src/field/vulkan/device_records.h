// SPDX-License-Identifier: Apache-2.0
// The data of a field in a device's memory.
#ifndef LAMBENT_FIELD_VULKAN_DEVICE_RECORDS_H
#define LAMBENT_FIELD_VULKAN_DEVICE_RECORDS_H

#include "field/correction/correction_math.h"
#include "field/edits/edited_light_math.h"
#include "field/lookup/lookup_records.h"
#include "field/transport/surfel_math.h"
#include "raytracing/ray_records.h"

LAMBENT_BEGIN

// Formats of the store's distances. The numbers are those of DistanceFormat.
const uint kRg16f = 0u;
const uint kRg32f = 1u;

/// SurfelLookup::tile_corner of a lookup that reads nothing.
const uint kNoLookup = 0xFFFFFFFFu;

LAMBENT_DEVICE_ARRAY(GridArray, ProbeGrid, 4)
LAMBENT_DEVICE_ARRAY(SurfelArray, SurfelRecord, 4)
LAMBENT_DEVICE_ARRAY(EditedLightArray, EditedLight, 4)
LAMBENT_DEVICE_ARRAY(LookupArray, SurfelLookup, 4)
LAMBENT_DEVICE_ARRAY(CornerOffsetsArray, CornerOffsets, 4)
LAMBENT_DEVICE_ARRAY(CorrectionKeyArray, CorrectionKey, 4)

/// A ray set. Its matrices have a row per ray, whose length is rounded up to whole blocks of
/// texels. The number of rows is rounded up to whole lane groups; rows beyond the rays are 0.
struct RaySetRecord {
  Vec3Array directions;
  FloatArray irradiance_weights;
  FloatArray distance_weights;
  int rays;
  uint update;
};
LAMBENT_DEVICE_ARRAY(RaySetArray, RaySetRecord, 8)

/// Consecutive probes of a list that last traced the same ray set: at most kBlockProbes, on which a
/// lane group of the matrix product works.
struct ProbeBlock {
  int first;
  int count;
  int ray_set;
};
LAMBENT_DEVICE_ARRAY(ProbeBlockArray, ProbeBlock, 4)

/// The arrays of a store.
struct StoreArrays {
  GridArray grids;
  UintArray offsets;
  UintArray irradiance;
  UintArray distance;
};

/// The arrays of the table of corrections that lookups read.
struct CorrectionArrays {
  CorrectionKeyArray keys;  ///< By slot.
  UintArray refined;        ///< kCellCorners for each slot.
  uint buckets;             ///< 0: the table is empty, and there are no arrays.
  uint picked;              ///< 1: lookups read single cells, as CorrectionUse::picked.
};

/// The probes that a pass works on: their indices, and the ray sets that they traced last.
struct ProbeList {
  IntArray probes;
  IntArray ray_sets;
  RaySetArray sets;
};

/// A point at which the field is looked up, like struct FieldQuery.
struct QueryRecord {
  vec3 position_ws;
  vec3 normal_ws;
  vec3 to_viewer_ws;
  float viewer_distance;  ///< [m]
};
LAMBENT_DEVICE_ARRAY(QueryArray, QueryRecord, 4)

LAMBENT_END
#endif
