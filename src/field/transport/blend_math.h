// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019. The weights of single rays and texels in a blend, and of an update in
// the blend with its probes' history.
#ifndef LAMBENT_FIELD_TRANSPORT_BLEND_MATH_H
#define LAMBENT_FIELD_TRANSPORT_BLEND_MATH_H

#include "field/probes/probe_grid.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// Smaller ray weights become 0. They make no difference in a float sum, but their products with
// values are denormal, and a hundred times slower to compute.
const float kMinRayWeight = 1e-30f;

/// The weight of a ray in a texel along `normal`.
LAMBENT_FN float ray_weight(vec3 normal, vec3 direction, float cosine_exponent) {
  float cosine = max(0.0f, dot(normal, direction));
  float weight = cosine_exponent == 1.0f ? cosine : pow(cosine, cosine_exponent);
  return weight < kMinRayWeight ? 0.0f : weight;
}

/// Exponent of the cosine in the ray weights of distances: sharp enough that an occluder in one
/// direction does not blur into the next texel. The published exponent is 50 (JCGT 8(2) 2019,
/// sec. 4.3). 100 is about as wide as a texel of the default tile and leaks less than half as much:
/// when it was chosen, the largest pixel of `scripts/measure leaks` with probes 1 m apart fell from
/// 9.1 % (at 50) to 3.9 %. 200 is no better.
const float kDistanceExponent = 100.0f;

// The distance of a ray that hits a side that bounds solid matter is scaled by this factor, so
// that a probe inside something has little weight in its surroundings. JCGT 10(2) 2021, sec. 4.
const float kBackFaceDistanceScale = 0.2f;

/// The distance that a ray counts as in a blend [m]. `seen` is the distance to its hit, infinite
/// for a miss.
LAMBENT_FN float counted_distance(float seen, uint back_face, float farthest) {
  float cut = min(seen, farthest);
  return back_face != 0u ? cut * kBackFaceDistanceScale : cut;
}

// A texel whose mean ray weight is below this received too few rays for an estimate.
const float kMinKnownWeight = 1e-4f;
// Keeps the division by the sum of weights finite for a texel for which no ray counts.
const float kTiniestWeight = 1e-20f;

/// The irradiance at a texel's centre: pi times the mean radiance, weighted by the cosine. `sums`
/// has the sums of radiance * cosine and, as its fourth channel, of cosines over the rays that
/// count.
LAMBENT_FN vec3 irradiance_at_centre(vec4 sums) {
  return vec3(sums) * (kPi / max(sums.w, kTiniestWeight));
}

/// The weight of new rays in the blend with a probe's history. The new rays amount to `weight`
/// updates, the history to `samples` updates, and the average remembers at most `longest` updates
/// (longest_average() in schedule/schedule.h, which depends on the hysteresis).
LAMBENT_FN float history_blend_weight(float samples, float weight, float longest) {
  float held = min(samples, max(longest - weight, 0.0f));
  return weight / (held + weight);
}

LAMBENT_END
#endif
