// SPDX-License-Identifier: Apache-2.0
// What a schedule goes by (schedule.h): how noisy a probe's light is found to be, by how much its
// error would fall with another ray, and how long it has waited. On the processor and on devices.
#ifndef LAMBENT_FIELD_SCHEDULE_SCHEDULE_MATH_H
#define LAMBENT_FIELD_SCHEDULE_SCHEDULE_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Updates after which a probe is served in any case, where the budget allows: two seconds at 60
/// Hz.
const uint kMaxProbeAge = 128u;

// The noise of a probe follows about so many of its last updates: what few rays meet, a shorter
// memory would forget.
const float kNoiseMemory = 32.0f;
// Noise below this is not believed after few updates: a probe that saw nothing bright yet may.
const float kMinNoise = 1e-4f;
// So many updates of noise are counted.
const uint kMaxNoiseSamples = 0xFFFFu;

// Noise of probes darker than this share of all is judged as if they were as bright: an eye that
// has adapted to the scene sees no more of it.
const float kDarkShare = 0.02f;

// A probe whose light is known this well rests until its age calls it: surfaces average the noise
// of eight.
const float kSettledError = 0.01f;

// No probe's noise is held to be less than this share of the mean when their turn is decided: light
// would come out too dark where few rays met what is bright.
const float kMinNoiseOfMean = 0.5f;

// Keeps the gain of probes that lost their light finite: samples of the least number of rays.
const float kFewestSamples = 0.1f;

/// What is known of a probe's noise: the relative variance of what an update tells, and the updates
/// that this has been learned from.
struct KnownNoise {
  float noise;
  uint samples;
};

/// What is known after an update of so much `weight` whose light was `relative_square` from that of
/// the `averaged` updates before.
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

/// The relative square of what an update told to what was held, from that of what is held after a
/// `share` of it was blended in. Noise is held to matter in proportion to the root of what it is
/// noise of (Rose, "The Sensitivity Performance of the Human Eye on an Absolute Scale", J. Opt.
/// Soc. Am. 38(2), 1948). `before`: luminance that was held; `mean_light`: of all probes.
LAMBENT_FN float estimate_relative_square(float relative_square, float before, float blend_weight,
                                          float mean_light) {
  float brightness = mean_light > 0.0f ? max(before, kDarkShare * mean_light) / mean_light : 1.0f;
  return relative_square * brightness / (blend_weight * blend_weight);
}

/// The mean light of `live` probes, of which `count` are found to have this one now.
LAMBENT_FN float learned_light(float mean_light, float now, float count, float live) {
  float rate = mean_light > 0.0f ? min(count / max(live, 1.0f), 1.0f) : 1.0f;
  return mean_light + rate * (now - mean_light);
}

/// The noise that a probe is scheduled by, a standard deviation. It is not held to be less than the
/// mean over it and its neighbours: its own is the lower the less of what is bright it has met so
/// far, and resting on it would leave the light too dark for good.
LAMBENT_FN float probe_noise(float own, float mean_around) {
  return sqrt(max(own, mean_around));
}

/// By how much a probe's error falls with each further sample, in proportion: a square error of
/// noise^2 / samples falls by noise^2 / samples^2. 0: it rests. `longest`: updates that an average
/// remembers.
LAMBENT_FN float error_reduction(float noise, float samples, float longest) {
  float counted = max(samples, kFewestSamples);
  if (samples >= longest || noise < kSettledError * sqrt(counted)) return 0.0f;
  return noise / counted;
}

/// The same per noise.
LAMBENT_FN float error_reduction_per_noise(float samples) {
  return 1.0f / max(samples, kFewestSamples);
}

/// Whether a probe has waited too long. Updates are counted from 1; served by 0: never.
LAMBENT_FN bool waits_too_long(uint served, uint update) {
  return served == 0u || update - served >= kMaxProbeAge;
}

LAMBENT_END
#endif
