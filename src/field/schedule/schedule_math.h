// SPDX-License-Identifier: Apache-2.0
// The formulas of the schedule (schedule.h), on the processor and on devices: the variance of a
// probe's light, how much another ray would reduce its error, and how long it has waited.
#ifndef LAMBENT_FIELD_SCHEDULE_SCHEDULE_MATH_H
#define LAMBENT_FIELD_SCHEDULE_SCHEDULE_MATH_H

#include "field/probes/probe_grid.h"
#include "field/probes/tile_light_math.h"

LAMBENT_BEGIN

/// A probe is traced after this many updates in any case, if the budget allows: two seconds at 60
/// Hz.
const uint kMaxProbeAge = 128u;

// The variance of a probe is an average over about this many of its updates. A shorter memory would
// forget bright light that few rays hit.
const float kVarianceMemory = 32.0f;
// The least variance of a probe. The estimate is too low for a probe whose rays have not hit bright
// light yet.
const float kMinVariance = 1e-4f;
// The number of updates from which a variance was learned is counted up to this.
const uint kMaxVarianceSamples = 0xFFFFu;

// Where the visibility of noise is estimated, probes darker than this fraction of the mean light
// count as this bright: an eye that is adapted to the scene does not see more noise in darker
// light.
const float kDarkShare = 0.02f;

// A probe with this relative standard error has converged, and waits until its age makes it urgent.
// Surfaces average the errors of eight probes.
const float kSettledError = 0.01f;

// A probe's priority is computed from at least this fraction of the mean deviation. Otherwise light
// would become too dark where few rays hit bright surfaces.
const float kMinDeviationOfMean = 0.5f;

// The least number of samples that a probe counts as having. It keeps the error reduction of probes
// without history finite, and is about the number of samples of the smallest ray class.
const float kFewestSamples = 0.1f;

/// The relative variance of the light that an update estimates for a probe, and the number of
/// updates from which it was learned.
struct VarianceEstimate {
  float variance;
  uint samples;
};

/// The variance after an update of this `weight`. `relative_square` is the relative square of the
/// difference between the update's estimate and the average of the `averaged` updates before it.
LAMBENT_FN VarianceEstimate learned_variance(VarianceEstimate known, float relative_square,
                                             float weight, float averaged) {
  if (averaged <= 0.0f) return known;
  // A difference of two means has the sum of their variances
  float one = relative_square / (1.0f / weight + 1.0f / averaged);
  known.samples = min(known.samples + 1u, kMaxVarianceSamples);
  float rate = max(1.0f / float(known.samples), 1.0f / kVarianceMemory);
  known.variance = max(known.variance + rate * (one - known.variance), kMinVariance);
  return known;
}

/// The relative square of the difference between an update's estimate and the light that a probe
/// held. It follows from the `change` of the light of a tile of `texels` texels by blending the
/// estimate in with `blend_weight`. The visibility of noise is taken to be proportional to the
/// square root of the light (Rose, "The Sensitivity Performance of the Human Eye on an Absolute
/// Scale", J. Opt. Soc. Am. 38(2), 1948). `mean_light` is the mean luminance of all probes.
LAMBENT_FN float estimate_relative_square(LightChange change, int texels, float blend_weight,
                                          float mean_light) {
  float before = max(change.before, kDarkShare * mean_light);
  float relative_square = mean_relative_square(change.squares, texels, before);
  float brightness = mean_light > 0.0f ? before / mean_light : 1.0f;
  return relative_square * brightness / (blend_weight * blend_weight);
}

/// The mean light of `live` probes after an update in which `count` of them have the mean light
/// `now`.
LAMBENT_FN float learned_light(float mean_light, float now, float count, float live) {
  float rate = mean_light > 0.0f ? min(count / max(live, 1.0f), 1.0f) : 1.0f;
  return mean_light + rate * (now - mean_light);
}

/// The standard deviation by which a probe is scheduled. Its square is at least the mean variance
/// of the probe and its neighbours. A probe's own variance is too low while its rays have hit
/// little bright light; if it alone decided that the probe has converged, the probe would stay too
/// dark.
LAMBENT_FN float probe_deviation(float own, float mean_around) {
  return sqrt(max(own, mean_around));
}

/// How much a further sample reduces a probe's error: a squared error of deviation^2 / samples
/// falls by about deviation^2 / samples^2, of which this is the square root. Returns 0 for a probe
/// that has converged. `longest` is the most updates that an average remembers.
LAMBENT_FN float error_reduction(float deviation, float samples, float longest) {
  float counted = max(samples, kFewestSamples);
  if (samples >= longest || deviation < kSettledError * sqrt(counted)) return 0.0f;
  return deviation / counted;
}

/// error_reduction() of a probe that has not converged, divided by its deviation.
LAMBENT_FN float error_reduction_per_deviation(float samples) {
  return 1.0f / max(samples, kFewestSamples);
}

/// The error reduction by which a probe, or a block of probes, is scheduled. `per_deviation` is 0
/// where it has converged.
LAMBENT_FN float scheduled_reduction(float reduction, float per_deviation, float mean_deviation) {
  return max(reduction, kMinDeviationOfMean * mean_deviation * per_deviation);
}

/// The greatest number of a probe's neighbours along the axes of its grid.
const int kNeighbours = 6;

/// The index of a neighbour, 0 to kNeighbours - 1, of the probe with these coordinates; -1 where
/// the grid ends.
LAMBENT_FN int neighbour_of(ProbeGrid grid, ivec3 coords, int neighbour) {
  int axis = neighbour / 2;
  coords[axis] += 2 * (neighbour % 2) - 1;
  bool exists = coords[axis] >= 0 && coords[axis] < grid.count[axis];
  return exists ? probe_index(grid, coords) : -1;
}

// The value of `last_traced` for a probe that takes no part in the schedule.
const uint kNotScheduled = 0xFFFFFFFFu;

/// Whether a probe has waited for kMaxProbeAge. Updates are counted from 1; `last_traced` is 0 for
/// a probe that was never traced.
LAMBENT_FN bool waits_too_long(uint last_traced, uint update) {
  return last_traced != kNotScheduled &&
         (last_traced == 0u || update >= last_traced + kMaxProbeAge);
}

/// The weight of probes by the level of their cascade: those of level L are traced 2^-L times as
/// often as those of level 0.
LAMBENT_FN float level_weight(int level) {
  return power_of_two(-level);
}

// The urgency of a probe is below 1 while its age is below kMaxProbeAge, between 1 and 2 above that
// age, and at least 2 where it has never been traced.
const float kOldUrgency = 1.0f;
const float kNeverUrgency = 2.0f;

/// The urgency of a probe from its error reduction and its weight; 0: it need not be traced. It
/// grows with both and with the age. For `last_traced` and `update`, see waits_too_long().
LAMBENT_FN float probe_urgency(float reduction, uint last_traced, uint update, float weight) {
  if (last_traced == 0u) return kNeverUrgency + weight;
  if (waits_too_long(last_traced, update)) {
    float age = float(update - last_traced);
    return kOldUrgency + age / (age + float(kMaxProbeAge));
  }
  return kOldUrgency * reduction * weight / (1.0f + reduction * weight);
}

LAMBENT_END
#endif
