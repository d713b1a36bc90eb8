// SPDX-License-Identifier: Apache-2.0
// Arguments of the kernels that work on a field in a device's memory. "Of probes" are arrays in
// the order of a pass's list; "of all probes" those by a probe's index.
#ifndef LAMBENT_FIELD_VULKAN_DEVICE_ARGUMENTS_H
#define LAMBENT_FIELD_VULKAN_DEVICE_ARGUMENTS_H

#include "field/vulkan/device_records.h"
#include "field/vulkan/device_solve.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

// Lanes that share what they load, in matrix products and sums: every subgroup holds some.
const int kLaneGroupSize = 8;
const int kGroupLanes = 64;
// Probes and texels that a cluster's matrix product keeps in registers; so many texels are blocks
// of a matrix's row.
const int kBlockProbes = 8;
const int kIrradianceVectors = 2;
const int kIrradianceBlock = 16;
const int kDistanceVectors = 4;
const int kDistanceBlock = 32;

/// Rays of probes that trace the same. `rays`: probes x rays.
struct ProbeRaysArguments {
  StoreArrays store;
  IntArray probes;
  Vec3Array directions;
  RayArray rays;
  int count;
  int rays_per_probe;
};

/// Surfels of the same, from what shading made of their hits.
struct MakeSurfelsArguments {
  IntArray probes;
  LitPointArray points;
  ShadedHitArray shaded;
  Vec3Array irradiance;
  SurfelArray surfels;  ///< All probes x stride.
  int count;
  int rays_per_probe;
  int stride;
};

/// What their hits count as in distances. `seen`: probes x seen_stride [m], 0 beyond the rays;
/// `blocked`: of probes, 1: stands in solid matter.
struct SeeDistancesArguments {
  GridArray grids;
  IntArray probes;
  HitArray hits;
  SurfelArray surfels;  ///< All probes x stride.
  FloatArray seen;
  UintArray blocked;
  int count;
  int rays_per_probe;
  int stride;
  int seen_stride;
};

/// Blends them into the store. `shares`: of probes.
struct BlendDistancesArguments {
  StoreArrays store;
  ProbeList list;
  ProbeBlockArray blocks;
  FloatArray seen;
  UintArray blocked;
  FloatArray blend_weights;
  int block_count;
  int stride;
  uint dither_seed;
};

/// What probes' surfels tell that rays saw. `seen`: a row of `seen_stride` a probe.
struct SeeSurfelsArguments {
  StoreArrays store;
  ProbeList list;
  SurfelArray surfels;
  FloatArray seen;
  UintArray blocked;
  int count;
  int stride;  ///< Surfels a probe.
  int seen_stride;
};

/// Moves what tiles hold by as much as what rays saw changed.
struct MoveDistancesArguments {
  StoreArrays store;
  ProbeList list;
  FloatArray seen_before;
  UintArray blocked_before;
  FloatArray seen;
  UintArray blocked;
  int count;
  int stride;
  uint dither_seed;
};

/// Sends importance back through surfels. `received` and `sent`: of all probes; the latter in whole
/// numbers, `scale` to one.
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

/// Copies tiles of a list's probes to where those of all probes are.
struct ScatterTilesArguments {
  IntArray probes;
  Vec4Array tiles;
  Vec4Array field;
  int count;
};

/// Fills a ray set's matrix of weights.
struct RayWeightsArguments {
  Vec3Array directions;
  FloatArray weights;
  int rays;
  int columns;
  int texels;  ///< Along a tile's edge.
  float cosine_exponent;
};

/// Fills the gutters of tiles.
struct GuttersArguments {
  UintArray words;
  IntArray probes;
  int count;
  int texels;
  int words_per_texel;
};

/// Points that look the field up, in rows: the surfels of a list's probes, a row a probe, or
/// queries, `stride` of them a row. Point i has kLookups lookups; a surfel's place i among those of
/// all probes is probe x stride + ray, a query's its place in the array.
struct LookupPoints {
  ProbeList list;
  SurfelArray surfels;
  QueryArray queries;
  int rows;
  int stride;
  int count;   ///< Of queries; 0: they are surfels.
  uint exact;  ///< 1: all corners are asked for by rays; 0: those that are in doubt.
};

/// Finds points' lookups by distances.
struct FindLookupsArguments {
  StoreArrays store;
  LookupPoints points;
  LookupArray lookups;
};

/// Rays between the corners of cells, by the probes that are their lowest. `rays`: cells x
/// kCellPairs.
struct CellVisibilityRaysArguments {
  StoreArrays store;
  IntArray cells;
  RayArray rays;
  int count;
};

/// What they found: two words a probe; see visibility_bit.
struct CellVisibilityBitsArguments {
  IntArray cells;
  UintArray occluded;
  UintArray cell_visibility;
  int count;
};

// A counter of rays: the size of an indirect dispatch of them, and how many were counted in all.
const int kRaysRequested = 0;
const int kRaysTotal = 3;
const int kCounterWords = 4;

/// The rays that a point asks, one after the other; for each of its lookups eight bits, by corners.
struct CornerTests {
  uint first_ray;
  uint tested;
};
LAMBENT_DEVICE_ARRAY(CornerTestArray, CornerTests, 4)

/// Asks rays for corners of lookups that were found by distances. `questions`: rows x stride.
struct TestCornersArguments {
  StoreArrays store;
  LookupPoints points;
  LookupArray lookups;
  UintArray cell_visibility;
  UintArray counter;
  CornerTestArray tests;
  RayArray rays;
};

/// Weighs lookups by the answers.
struct ApplyCornerTestsArguments {
  StoreArrays store;
  LookupPoints points;
  LookupArray lookups;
  CornerTestArray tests;
  UintArray occluded;
};

/// Irradiance for queries whose lookups were found. `lookups`: count x kLookups.
struct ReadLookupsArguments {
  StoreArrays store;
  QueryArray queries;
  LookupArray lookups;
  Vec3Array irradiance;
  int count;
};

// What rays bring back: all light, direct and sky light, the sky's alone.
const uint kGatherAll = 0u;
const uint kGatherDirect = 1u;
const uint kGatherSky = 2u;

/// Radiance along rays, and whether they count. `field`: of all probes x texels; `radiance`: probes
/// x stride.
struct GatherArguments {
  ProbeList list;
  CornerOffsetsArray corners;
  SurfelArray surfels;
  LookupArray lookups;
  Vec4Array field;
  Vec4Array radiance;
  int probes;
  int stride;           ///< Of surfels.
  int radiance_stride;  ///< The probes' most rays, up to a whole cluster.
  uint light;
};

/// Irradiance at texels' centres from radiance; w: 1 where enough rays count. Probes x texels.
struct ReceiveArguments {
  ProbeList list;
  ProbeBlockArray blocks;
  Vec4Array radiance;
  Vec4Array at_centres;
  int block_count;
  int stride;
};

/// What to store from that, times `gain`. Probes x texels.
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

/// Encodes light. `light`: of all probes x texels.
struct StoreIrradianceArguments {
  UintArray words;
  IntArray probes;
  Vec4Array light;
  int count;
  uint dither_seed;
};

/// By how much light changed. `before`: probes x texels; `changes`: of probes.
struct CompareLightArguments {
  IntArray probes;
  Vec4Array light;
  Vec4Array before;
  Vec3Array changes;  ///< Relative square, luminance before, luminance now.
  int count;
  float darkest;
};

struct LookupArguments {
  StoreArrays store;
  QueryArray queries;
  Vec3Array irradiance;
  int count;
  int width;  ///< Queries in a row of the dispatch.
};

LAMBENT_END
#endif
