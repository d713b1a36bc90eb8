// SPDX-License-Identifier: Apache-2.0
// Arguments of the kernels that work on a field in a device's memory. Arrays "of the list" have
// entries in the order of a pass's list of probes; arrays "of all probes" are indexed by a probe's
// index.
#ifndef LAMBENT_FIELD_VULKAN_DEVICE_ARGUMENTS_H
#define LAMBENT_FIELD_VULKAN_DEVICE_ARGUMENTS_H

#include "field/correction/correction_records.h"
#include "field/vulkan/device_records.h"
#include "field/vulkan/device_solve.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

// The number of lanes of a lane group. They share loaded values in matrix products and sums. Every
// subgroup holds whole lane groups. kGroupLanes is the number of lanes of a workgroup.
const int kLaneGroupSize = 8;
const int kGroupLanes = 64;
// The number of probes, and of vectors of texels, that a lane group's matrix product holds in
// registers, and the number of texels of these vectors together (a block). Rows of a matrix are
// padded to whole blocks of texels.
const int kBlockProbes = 8;
const int kIrradianceVectors = 2;
const int kIrradianceBlock = 16;
const int kDistanceVectors = 4;
const int kDistanceBlock = 32;

/// Arguments of probe_rays, for probes that trace the same ray set. `rays` has count x
/// rays_per_probe entries.
struct ProbeRaysArguments {
  StoreArrays store;
  IntArray probes;
  Vec3Array directions;
  RayArray rays;
  int count;
  int rays_per_probe;
};

/// Arguments of make_surfels, which makes surfels from shaded hits, for probes that trace the same
/// ray set.
struct MakeSurfelsArguments {
  IntArray probes;
  LitPointArray points;
  ShadedHitArray shaded;
  Vec3Array irradiance;
  SurfelArray surfels;  ///< `stride` entries for each probe of the field.
  int count;
  int rays_per_probe;
  int stride;
};

/// Arguments of hit_distances. `distances` receives the distances that hits count as [m],
/// `distance_stride` per probe of the list, 0 beyond its rays. `blocked` receives 1 for each probe
/// of the list that stands inside geometry, else 0.
struct HitDistancesArguments {
  GridArray grids;
  IntArray probes;
  HitArray hits;
  SurfelArray surfels;  ///< All probes x stride.
  FloatArray distances;
  UintArray blocked;
  int count;
  int rays_per_probe;
  int stride;
  int distance_stride;
};

/// Arguments of blend_distances, which blends the distances of hit_distances or surfel_distances
/// into the store. `blend_weights` are of the list.
struct BlendDistancesArguments {
  StoreArrays store;
  ProbeList list;
  ProbeBlockArray blocks;
  FloatArray distances;
  UintArray blocked;
  FloatArray blend_weights;
  int block_count;
  int stride;
  uint dither_seed;
};

/// Arguments of surfel_distances, which computes `distances` and `blocked` as hit_distances does,
/// but from surfels.
struct SurfelDistancesArguments {
  StoreArrays store;
  ProbeList list;
  SurfelArray surfels;
  FloatArray distances;
  UintArray blocked;
  int count;
  int stride;  ///< Surfels per probe.
  int distance_stride;
};

// The steps of edited_light.
const uint kKeepLight = 0u;     ///< Stores `light_before`.
const uint kCompareLight = 1u;  ///< Computes `edited`.

/// Arguments of edited_light, which compares direct light along rays before and after an edit.
struct EditedLightArguments {
  ProbeList list;
  SurfelArray surfels;
  FloatArray light_before;  ///< Of the list's rays.
  EditedLightArray edited;  ///< Of the list's probes.
  int count;
  int stride;      ///< Surfels per probe.
  int ray_stride;  ///< Rays per probe of `light_before`.
  uint step;
};

/// Arguments of move_distances, which shifts stored moments by the change in the rays' moments.
struct MoveDistancesArguments {
  StoreArrays store;
  ProbeList list;
  FloatArray distances_before;
  UintArray blocked_before;
  FloatArray distances;
  UintArray blocked;
  int count;
  int stride;
  uint dither_seed;
};

/// Arguments of scatter_importance. `received` and `sent` are of all probes. `sent` holds
/// fixed-point numbers, in which `scale` stands for 1.
struct ScatterImportanceArguments {
  ProbeList list;
  CornerOffsetsArray corners;
  SurfelArray surfels;
  LookupArray lookups;
  FloatArray received;
  UintArray sent;
  int count;
  int stride;
  float scale;
};

/// Arguments of scatter_tiles, which copies the tiles of a list into the array of all probes'
/// tiles.
struct ScatterTilesArguments {
  IntArray probes;
  Vec4Array tiles;
  Vec4Array field;
  int count;
};

/// Arguments of ray_weights, which computes a ray set's matrix.
struct RayWeightsArguments {
  Vec3Array directions;
  FloatArray weights;
  int rays;
  int columns;
  int texels;  ///< Along a tile's edge.
  float cosine_exponent;
};

/// Arguments of gutters, which fills the gutters of tiles.
struct GuttersArguments {
  UintArray words;
  IntArray probes;
  int count;
  int texels;
  int words_per_texel;
};

/// Points at which the field is looked up, in rows. They are either the surfels of a list's probes,
/// one row per probe, or queries, `stride` of them per row. Each point has kLookups consecutive
/// lookups. Those of a surfel begin at the index kLookups x (probe x stride + ray), and those of a
/// query at kLookups x its index in the array.
struct LookupPoints {
  ProbeList list;
  SurfelArray surfels;
  QueryArray queries;
  int rows;
  int stride;
  int count;   ///< Number of queries; 0 where the points are surfels.
  uint exact;  ///< 1: all corners are tested with rays; 0: only those in doubt.
};

/// Arguments of find_lookups, which finds the lookups of points, with visibility by distances.
struct FindLookupsArguments {
  StoreArrays store;
  LookupPoints points;
  LookupArray lookups;
  CorrectionArrays corrections;  ///< None: lookups are not corrected.
};

// Words of a ray counter: the size of an indirect dispatch of the requested rays (three words); the
// first cell, or row of points, of this dispatch among all; the number of all cells; the number of
// all rows; and the total number of rays since the counter was read last. The device may know the
// numbers of cells and rows alone.
const int kRaysRequested = 0;
const int kFirstItem = 3;
const int kCellsListed = 4;
const int kRowsListed = 5;
const int kRaysTotal = 6;
const int kCounterWords = 7;

/// Arguments of cells_around, which lists the cells that have one of kRowsListed probes as a
/// corner, by their lowest probes and in any order. `marks` has a word for each of all probes, all
/// 0 at first.
struct CellsAroundArguments {
  GridArray grids;
  IntArray probes;
  UintArray marks;
  IntArray cells;
  UintArray counter;
};

/// Arguments of cell_visibility_rays, which makes the rays between the corners of at most `count`
/// listed cells. `cells` holds the lowest probes of all listed cells, and `rays` has kCellPairs
/// entries per cell of this dispatch.
struct CellVisibilityRaysArguments {
  StoreArrays store;
  IntArray cells;
  RayArray rays;
  UintArray counter;
  int count;
  int unused;
};

/// Arguments of cell_visibility_bits, which stores the results in two words per lowest probe
/// (all_visible).
struct CellVisibilityBitsArguments {
  IntArray cells;
  UintArray occluded;
  UintArray cell_visibility;
  UintArray counter;
  int count;
  int unused;
};

/// The visibility rays of a point, which are consecutive. `tested` has eight bits per lookup, one
/// per corner.
struct CornerTests {
  uint first_ray;
  uint tested;
};
LAMBENT_DEVICE_ARRAY(CornerTestArray, CornerTests, 4)

/// Arguments of test_corners, which makes visibility rays for corners of lookups that find_lookups
/// found. `tests` has rows x stride entries.
struct TestCornersArguments {
  StoreArrays store;
  LookupPoints points;
  LookupArray lookups;
  UintArray cell_visibility;
  UintArray counter;
  CornerTestArray tests;
  RayArray rays;
};

/// Arguments of apply_corner_tests, which computes the lookups' weights from the results of the
/// rays of test_corners.
struct ApplyCornerTestsArguments {
  StoreArrays store;
  LookupPoints points;
  LookupArray lookups;
  UintArray cell_visibility;
  CornerTestArray tests;
  UintArray occluded;
  UintArray counter;
};

/// Arguments of read_lookups, which computes the irradiance for queries whose lookups were found.
/// `lookups` has kLookups entries per query.
struct ReadLookupsArguments {
  StoreArrays store;
  QueryArray queries;
  LookupArray lookups;
  Vec3Array irradiance;
  int count;
};

// The light that rays gather: all of it, or sky light only.
const uint kGatherAll = 0u;
const uint kGatherSky = 1u;

/// Arguments of gather, which gathers radiance along rays. `field` has the texels of all probes,
/// and `radiance` has `radiance_stride` entries per probe of the list.
struct GatherArguments {
  ProbeList list;
  CornerOffsetsArray corners;
  SurfelArray surfels;
  LookupArray lookups;
  Vec4Array field;
  Vec4Array radiance;
  int probes;
  int stride;           ///< Surfels per probe.
  int radiance_stride;  ///< The list's largest number of rays, rounded up to whole lane groups.
  uint light;
};

/// Arguments of receive, which computes the irradiance at texels' centres from the radiance along
/// rays. The fourth channel is 1 for texels for which enough rays count, else 0. Arrays have the
/// texels of the list.
struct ReceiveArguments {
  ProbeList list;
  ProbeBlockArray blocks;
  Vec4Array radiance;
  Vec4Array at_centres;
  int block_count;
  int stride;
};

/// Arguments of fit, which computes the values that tiles store from the irradiance at texels'
/// centres, and multiplies them by `history_ratio`. Arrays have the texels of the list.
struct FitArguments {
  FloatArray fit;
  ProbeBlockArray blocks;
  Vec4Array at_centres;
  Vec4Array fallback;
  Vec4Array history_ratio;
  Vec4Array received;
  int block_count;
  uint has_history_ratio;
};

/// Arguments of store_irradiance. `light` has the texels of all probes.
struct StoreIrradianceArguments {
  UintArray words;
  IntArray probes;
  Vec4Array light;
  UintArray changed;  ///< One word per probe of the list; 0: its stored tile stays.
  int count;
  uint dither_seed;
  uint has_changed;  ///< 0: there is no `changed`, and all probes of the list are stored.
  uint unused;
};

/// Arguments of compare_light. `before` has the texels of the list, `changes` an entry per probe of
/// the list.
struct CompareLightArguments {
  IntArray probes;
  Vec4Array light;
  Vec4Array before;
  Vec3Array changes;  ///< The members of LightChange.
  int count;
  int unused;
};

/// Arguments of lookup, which looks the field up for queries.
struct LookupArguments {
  StoreArrays store;
  QueryArray queries;
  Vec3Array irradiance;
  int count;
  int width;                     ///< Queries per row of the dispatch.
  CorrectionArrays corrections;  ///< None: lookups are not corrected.
};

/// Arguments of hit_queries, which writes a query for the hit of each ray. Those of rays that were
/// not traced, and of hits that reflect nothing, have a normal of 0, which lookups by rays skip;
/// their answers are not to be read.
struct HitQueriesArguments {
  LitPointArray hit_points;
  ShadedHitArray shaded;
  RayArray rays;
  QueryArray queries;
  uint count;
  uint unused;
};

LAMBENT_END
#endif
