// SPDX-License-Identifier: Apache-2.0
// What the schedule depends on (schedule.h), on the processor and on devices: the noise of a
// probe's light, how much another ray would reduce its error, and how long it has waited.
#ifndef LAMBENT_FIELD_SCHEDULE_SCHEDULE_MATH_H
#define LAMBENT_FIELD_SCHEDULE_SCHEDULE_MATH_H

#include "field/probes/probe_grid.h"
#include "field/probes/tile_light_math.h"

LAMBENT_BEGIN

/// A probe is traced after this many updates in any case, if the budget allows: two seconds at 60
/// Hz.
const uint kMaxProbeAge = 128u;

// The noise of a probe is an average over about this many of its updates. A shorter memory would
// forget bright light that few rays hit.
const float kNoiseMemory = 32.0f;
// The least noise of a probe: one that has not hit bright light yet may seem to have less.
const float kMinNoise = 1e-4f;
// The number of updates of noise is counted up to this.
const uint kMaxNoiseSamples = 0xFFFFu;

// Probes darker than this fraction of the mean light count as this bright where noise is judged: an
// eye that is adapted to the scene sees no more noise than that.
const float kDarkShare = 0.02f;

// A probe with this relative standard error has converged, and waits until its age makes it urgent.
// Surfaces average the noise of eight probes.
const float kSettledError = 0.01f;

// For its priority, no probe's noise counts as less than this fraction of the mean noise. Otherwise
// light would become too dark where few rays hit what is bright.
const float kMinNoiseOfMean = 0.5f;

// The least number of samples that counts. It keeps the error reduction of probes without history
// finite, and is about what the smallest ray class amounts to.
const float kFewestSamples = 0.1f;

/// The noise of a probe: the relative variance of the light that an update estimates, and the
/// number of updates from which it was learned.
struct KnownNoise {
  float noise;
  uint samples;
};

/// The noise after an update of this `weight`. `relative_square` is the relative square of the
/// difference between what it estimated and the average of the `averaged` updates before it.
LAMBENT_FN KnownNoise learned_noise(KnownNoise known, float relative_square, float weight,
                                    float averaged) {
  if (averaged <= 0.0f) return known;
  // A difference of two means has the sum of their variances
  float one = relative_square / (1.0f / weight + 1.0f / averaged);
  known.samples = min(known.samples + 1u, kMaxNoiseSamples);
  float rate = max(1.0f / float(known.samples), 1.0f / kNoiseMemory);
  known.noise = max(known.noise + rate * (one - known.noise), kMinNoise);
  return known;
}

/// The relative square of the difference between an update's estimate and the light that a probe
/// held. It follows from the `change` of the light of a tile of `texels` texels by blending the
/// estimate in with `blend_weight`. The visibility of noise is taken to be proportional to the
/// square root of the light (Rose, "The Sensitivity Performance of the Human Eye on an Absolute
/// Scale", J. Opt. Soc. Am. 38(2), 1948). `mean_light` is the luminance of all probes.
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

/// The noise by which a probe is scheduled, as a standard deviation. It is at least the mean over
/// the probe and its neighbours. A probe's own noise is the lower, the less bright light its rays
/// have hit so far; a probe that converged by it would stay too dark for good.
LAMBENT_FN float probe_noise(float own, float mean_around) {
  return sqrt(max(own, mean_around));
}

/// How much a further sample reduces a probe's error, up to a constant factor: a squared error of
/// noise^2 / samples falls by noise^2 / samples^2. Returns 0 for a probe that has converged.
/// `longest` is the most updates that an average remembers.
LAMBENT_FN float error_reduction(float noise, float samples, float longest) {
  float counted = max(samples, kFewestSamples);
  if (samples >= longest || noise < kSettledError * sqrt(counted)) return 0.0f;
  return noise / counted;
}

/// error_reduction() of a probe that has not converged, divided by its noise.
LAMBENT_FN float error_reduction_per_noise(float samples) {
  return 1.0f / max(samples, kFewestSamples);
}

/// The error reduction by which a probe, or a block of probes, is scheduled. `per_noise` is 0 where
/// it has converged.
LAMBENT_FN float scheduled_reduction(float reduction, float per_noise, float mean_noise) {
  return max(reduction, kMinNoiseOfMean * mean_noise * per_noise);
}

/// The neighbours of a probe along the axes of its grid: their greatest number.
const int kNeighbours = 6;

/// The index of a neighbour, 0 to kNeighbours - 1, of the probe with these coordinates; -1 where
/// the grid ends.
LAMBENT_FN int neighbour_of(ProbeGrid grid, ivec3 coords, int neighbour) {
  int axis = neighbour / 2;
  coords[axis] += 2 * (neighbour % 2) - 1;
  bool exists = coords[axis] >= 0 && coords[axis] < grid.count[axis];
  return exists ? probe_index(grid, coords) : -1;
}

// The number of the last update of a probe that takes no part.
const uint kNotLive = 0xFFFFFFFFu;

/// Whether a probe has waited for kMaxProbeAge. Updates are counted from 1; `served` is 0 for a
/// probe that was never traced.
LAMBENT_FN bool waits_too_long(uint served, uint update) {
  return served != kNotLive && (served == 0u || update - served >= kMaxProbeAge);
}

/// The weight of probes by the level of their cascade: those of level L are traced 2^L times as
/// seldom.
LAMBENT_FN float level_weight(int level) {
  return power_of_two(-level);
}

// The urgency of a probe is below 1 while its age is below kMaxProbeAge, between 1 and 2 above that
// age, and at least 2 where it has never been traced.
const float kOldUrgency = 1.0f;
const float kNeverUrgency = 2.0f;

/// The urgency of a probe from its error reduction and its weight; 0: it need not be traced. It
/// grows with both and with the age. For `served` and `update`, see waits_too_long().
LAMBENT_FN float probe_urgency(float reduction, uint served, uint update, float weight) {
  if (served == 0u) return kNeverUrgency + weight;
  if (waits_too_long(served, update)) {
    float age = float(update - served);
    return kOldUrgency + age / (age + float(kMaxProbeAge));
  }
  return kOldUrgency * reduction * weight / (1.0f + reduction * weight);
}

LAMBENT_END
#endif
