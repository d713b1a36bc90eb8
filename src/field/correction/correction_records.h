// SPDX-License-Identifier: Apache-2.0
// The table of corrections in a device's memory, and the arguments of the kernels that update it.
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

/// A point at which light is gathered; its position and normal are in a QueryRecord.
struct TrainingPointRecord {
  vec3 geometric_normal_ws;
  float gi_share;  ///< 0: there is no point.
  uint index;      ///< Seeds the point's random numbers.
};
LAMBENT_DEVICE_ARRAY(TrainingPointArray, TrainingPointRecord, 4)

/// Like struct CorrectionSample. Where `looked_up` is 0, there is no sample.
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

/// A surfel at which an update gathers light: its index among all surfels, and the ray that hit it.
struct TrainingSurfelRecord {
  int probe;
  uint surfel;
  int ray;
  int ray_set;
};
LAMBENT_DEVICE_ARRAY(TrainingSurfelArray, TrainingSurfelRecord, 4)

/// Arguments of training_points, which makes a point from each surfel.
struct TrainingPointsArguments {
  StoreArrays store;
  TrainingSurfelArray trained;
  SurfelArray surfels;
  RaySetArray sets;
  TrainingPointArray points;
  QueryArray queries;
  uint first;  ///< Index of the first trained surfel.
  uint count;
};

/// Arguments of training_rays, which draws kTrainingRays rays for each point.
struct TrainingRaysArguments {
  TrainingPointArray points;
  QueryArray queries;
  RayArray rays;
  UintArray first_indices;  ///< Index of each point's first ray among all rays of the update.
  UintArray ray_count;      ///< Number of rays drawn so far: one word.
  uint count;
  uint number;
  uint seed;
  uint unused;
};

/// Arguments of training_samples, which compares the gathered irradiance of points with that of
/// lookups, and then replaces each point by the hit of one of its rays.
struct TrainingSamplesArguments {
  StoreArrays store;
  TrainingPointArray points;
  QueryArray queries;
  RayArray rays;
  LitPointArray hit_points;
  ShadedHitArray shaded;
  Vec3Array direct;
  Vec3Array arrives;  ///< The field's irradiance at the rays' hits.
  LookupArray lookups;
  CorrectionSampleArray samples;  ///< One for each lookup of each point.
  uint count;
  uint number;
  uint seed;
  uint unused;
};

// The indices, and the length, of an array of numbers that an update's samples share: the mean
// irradiance of lookups, 0 where there are no samples; and the number of samples that each one
// counts as.
const uint kCorrectionMean = 0u;
const uint kCorrectionWorth = 1u;
const uint kCorrectionSummary = 2u;

/// Arguments of correction_mean, which computes the `summary` of an update's samples.
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
  UintArray first_items;      ///< For each bucket, the place of its first item, from 1; 0: none.
  uint buckets;
  uint count;  ///< Number of samples.
};

/// Arguments of merge_corrections, which adds listed samples to the table.
struct MergeCorrectionsArguments {
  CorrectionKeyArray keys;
  LearnedArray learned;
  FloatArray summary;
  CorrectionItemArray items;
  UintArray first_items;
  uint buckets;
  float keep;
};

/// Arguments of refine_corrections, which computes the values that lookups read from the cells of
/// one level.
struct RefineCorrectionsArguments {
  CorrectionArrays table;
  LearnedArray learned;
  uint level;
  uint unused;
};

/// Arguments of forget_corrections, which reduces the weights of samples around probes.
struct ForgetCorrectionsArguments {
  CorrectionKeyArray keys;
  LearnedArray learned;
  GridArray grids;
  FloatArray kept;  ///< For each probe, the factor of the weights of the samples around it.
  uint slots;
  uint unused;
};

LAMBENT_END
#endif
