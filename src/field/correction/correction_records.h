// SPDX-License-Identifier: Apache-2.0
// The table of corrections in a device's memory, and the arguments of the kernels that teach it.
#ifndef LAMBENT_FIELD_CORRECTION_CORRECTION_RECORDS_H
#define LAMBENT_FIELD_CORRECTION_CORRECTION_RECORDS_H

#include "field/correction/correction_math.h"
#include "field/vulkan/device_records.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

LAMBENT_DEVICE_ARRAY(LearnedArray, LearnedCorrection, 4)
LAMBENT_DEVICE_ARRAY(CorrectionItemArray, CorrectionItem, 4)

// Invocations per row of the kernels that work on all cells or samples: large enough that the rows
// do not exceed any device's limit.
const uint kCorrectionRow = 1u << 20u;

/// What is known beside a query of a point at which light is gathered.
struct TrainingPointRecord {
  vec3 geometric_normal_ws;
  float gi_share;  ///< 0: there is no point.
  uint index;      ///< Picks its random numbers.
};
LAMBENT_DEVICE_ARRAY(TrainingPointArray, TrainingPointRecord, 4)

/// As struct CorrectionSample; with a looked-up irradiance of 0 it is none.
struct CorrectionSampleRecord {
  vec3 position_ws;
  vec3 normal_ws;
  int volume;
  float gathered;
  float variance;
  float looked_up;
  float pick;
};
LAMBENT_DEVICE_ARRAY(CorrectionSampleArray, CorrectionSampleRecord, 4)

/// A surfel that an update learns at: its place among all surfels, and the ray that found it.
struct TrainedSurfelRecord {
  int probe;
  uint surfel;
  int ray;
  int ray_set;
};
LAMBENT_DEVICE_ARRAY(TrainedSurfelArray, TrainedSurfelRecord, 4)

/// Arguments of training_points, which makes points of surfels.
struct TrainingPointsArguments {
  StoreArrays store;
  TrainedSurfelArray trained;
  SurfelArray surfels;
  RaySetArray sets;
  TrainingPointArray points;
  QueryArray queries;
  uint first;  ///< Of the trained surfels.
  uint count;
};

/// Arguments of training_rays, which draws kTrainingRays rays for each point.
struct TrainingRaysArguments {
  TrainingPointArray points;
  QueryArray queries;
  RayArray rays;
  UintArray first_indices;  ///< Of a point's rays among all rays of the update.
  UintArray ray_count;      ///< Rays drawn so far: one number.
  uint count;
  uint number;
  uint seed;
  uint unused;
};

/// Arguments of training_queries, which asks the field for light where the rays end.
struct TrainingQueriesArguments {
  LitPointArray hit_points;
  RayArray rays;
  QueryArray queries;
  uint count;
  uint unused;
};

/// Arguments of training_samples, which compares what points gather with what lookups find there,
/// and then replaces each point by one that its rays met.
struct TrainingSamplesArguments {
  StoreArrays store;
  TrainingPointArray points;
  QueryArray queries;
  RayArray rays;
  LitPointArray hit_points;
  ShadedHitArray shaded;
  Vec3Array direct;
  Vec3Array arrives;  ///< Of the field, at the rays' ends.
  LookupArray lookups;
  CorrectionSampleArray samples;  ///< As many for each point as lookups.
  uint count;
  uint number;
  uint seed;
  uint unused;
};

// What an update's samples have in common, as numbers of an array: the mean of what lookups find, 0
// where there are no samples, and how many samples each one counts as.
const uint kCorrectionMean = 0u;
const uint kCorrectionWorth = 1u;
const uint kCorrectionSummary = 2u;

/// Arguments of correction_mean, which finds what the samples of an update have in common.
struct CorrectionMeanArguments {
  CorrectionSampleArray samples;
  FloatArray summary;  ///< kCorrectionSummary numbers.
  uint count;
  uint unused;
};

/// Arguments of correction_items, which lists samples in the buckets of their blocks.
struct CorrectionItemsArguments {
  CorrectionSampleArray samples;
  FloatArray summary;
  GridArray grids;
  CorrectionItemArray items;  ///< kCorrectionLevels for each sample.
  UintArray first_items;      ///< By bucket: the place of its first item, from 1; 0: none.
  uint buckets;
  uint count;  ///< Of the samples.
};

/// Arguments of merge_corrections, which takes listed samples into the table.
struct MergeCorrectionsArguments {
  CorrectionKeyArray keys;
  LearnedArray learned;
  FloatArray summary;
  CorrectionItemArray items;
  UintArray first_items;
  uint buckets;
  float keep;
};

/// Arguments of refine_corrections, which finds what lookups read from the cells of one level.
struct RefineCorrectionsArguments {
  CorrectionArrays table;
  LearnedArray learned;
  uint level;
  uint unused;
};

/// Arguments of forget_corrections.
struct ForgetCorrectionsArguments {
  CorrectionKeyArray keys;
  LearnedArray learned;
  GridArray grids;
  FloatArray kept;  ///< By probe: how much of what was learned still counts.
  uint slots;
  uint unused;
};

LAMBENT_END
#endif
