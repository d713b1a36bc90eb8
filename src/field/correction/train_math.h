// SPDX-License-Identifier: Apache-2.0
// The choice of the points at which corrections are learned, and of their rays.
#ifndef LAMBENT_FIELD_CORRECTION_TRAIN_MATH_H
#define LAMBENT_FIELD_CORRECTION_TRAIN_MATH_H

#include "field/correction/correction_math.h"
#include "raytracing/surface_math.h"
#include "shared/sampling.h"
#include "shared/variance.h"

LAMBENT_BEGIN

// Rays of a gather. Fewer rays at more points cost more lookups for the same noise.
const int kTrainingRays = 8;

// Secondary gathers that follow each of these rays at most (field/secondary/secondary_math.h).
// Where lookups alone light the hits that are near, other cells learn what those there have learned
// by chance, and it grows. docs/math.md, "Corrections", measures 1, 2 and 4.
const int kMaxTrainingSecondaryRays = 2;

// A gather starts at one in this many of an update's surfels, and a second one at the hit of one of
// its rays, since surfels leave out surfaces that no probe ray reaches. The first updates fill the
// coarse levels, also where some of them trace the noisiest probes alone (docs/performance.md), and
// later ones only refine the estimates.
const uint kFirstTrainingStride = 16u;
const uint kTrainingStride = 32u;
const uint kSettledTrainingStride = 128u;

// The numbers of the updates from which kTrainingStride and kSettledTrainingStride apply.
const uint kFilledTraining = 5u;
const uint kSettledTraining = 24u;

// The purposes of the random numbers of training. Each purpose has a sequence of its own.
const uint kTrainingPicks = 0x7261701u;
const uint kTrainingShifts = 0x7261702u;
const uint kTrainingFollows = 0x7261703u;
const uint kTrainingAxes = 0x7261704u;

// The index of a point at the hit of another point's ray is the other point's index plus this. The
// indices of the rays of all points still differ in 32 bits.
const uint kFollowingPoint = 1u << 28u;

/// The index that stands for no ray.
const uint kNoTrainingRay = 0xFFFFFFFFu;

/// A random number in [0, 1) for a point of update `number` and one of the purposes above.
LAMBENT_FN float training_random(uint point, uint number, uint what, uint seed) {
  RandomStream random = make_random_stream(point, number, seed ^ what);
  return next_uniform(random);
}

/// Update `number` learns at one surfel in this many.
LAMBENT_FN uint training_stride(uint number) {
  if (number < kFilledTraining) return kFirstTrainingStride;
  return number < kSettledTraining ? kTrainingStride : kSettledTrainingStride;
}

/// The surfel at which update `number` places its point `point`, as an index among the surfels of
/// all probes of the update.
LAMBENT_FN uint training_surfel(uint point, uint number, uint seed) {
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
