// SPDX-License-Identifier: Apache-2.0
// Which points corrections are learned at, and what a sample there is.
#ifndef LAMBENT_FIELD_CORRECTION_TRAIN_MATH_H
#define LAMBENT_FIELD_CORRECTION_TRAIN_MATH_H

#include "field/correction/correction_math.h"
#include "raytracing/surface_math.h"
#include "shared/sampling.h"
#include "shared/variance.h"

LAMBENT_BEGIN

// Rays of a gather. Fewer rays at more points cost more lookups for the same noise.
const int kTrainingRays = 8;

// A gather starts from one of so many of an update's surfels, and another one from one of the
// points that its rays met: surfels alone leave out what no probe sees. The first updates fill the
// coarse levels, and later ones only confirm what is known.
const uint kFirstTrainingStride = 16u;
const uint kTrainingStride = 32u;
const uint kSettledTrainingStride = 128u;

// From these updates on, the later strides hold.
const uint kFilledTraining = 5u;
const uint kSettledTraining = 24u;

// What the random numbers of training are for. Each is a sequence of its own.
const uint kTrainingPicks = 0x7261701u;
const uint kTrainingShifts = 0x7261702u;
const uint kTrainingFollows = 0x7261703u;
const uint kTrainingAxes = 0x7261704u;

// Points that follow others have numbers of their own: so much above those that they follow. The
// numbers of all their rays still differ in 32 bits.
const uint kFollowingPoint = 1u << 28u;

/// The name of no ray.
const uint kNoTrainingRay = 0xFFFFFFFFu;

/// A random number in [0, 1) for a point of update `number` and one of the purposes above.
LAMBENT_FN float training_random(uint point, uint number, uint what, uint seed) {
  RandomStream random = make_random_stream(point, number, seed ^ what);
  return next_uniform(random);
}

/// How many surfels there are for each that update `number` learns at.
LAMBENT_FN uint training_stride(uint number) {
  if (number < kFilledTraining) return kFirstTrainingStride;
  return number < kSettledTraining ? kTrainingStride : kSettledTrainingStride;
}

/// The surfel at which an update learns as its point number `point`; its index among the surfels of
/// all its probes.
LAMBENT_FN uint trained_surfel(uint point, uint number, uint seed) {
  uint stride = training_stride(number);
  return point * stride +
         uint(training_random(point, number, kTrainingPicks, seed) * float(stride));
}

/// Direction of one of a point's rays.
LAMBENT_FN vec3 training_direction(Frame frame, uint point, uint number, int ray, uint seed) {
  RandomStream random = make_random_stream(point, number, seed ^ kTrainingShifts);
  vec2 shift = next_uniform2(random);
  return to_world(frame, sample_cosine_hemisphere(fract(shift + plastic_sequence(uint(ray)))));
}

LAMBENT_END
#endif
