// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019. What single rays and texels count for in a blend.
#ifndef LAMBENT_FIELD_TRANSPORT_BLEND_MATH_H
#define LAMBENT_FIELD_TRANSPORT_BLEND_MATH_H

#include "field/probes/probe_grid.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// Smaller weights count for nothing in a float sum, but their products with values are denormal and
// a hundred times slower to compute.
const float kMinRayWeight = 1e-30f;

/// Weight of a ray in a texel along `normal`.
LAMBENT_FN float ray_weight(vec3 normal, vec3 direction, float cosine_exponent) {
  float cosine = max(0.0f, dot(normal, direction));
  float weight = cosine_exponent == 1.0f ? cosine : pow(cosine, cosine_exponent);
  return weight < kMinRayWeight ? 0.0f : weight;
}

/// Exponent of the cosine with which rays count for a distance texel: sharp enough that what blocks
/// one direction does not blur into the next. Published: 50 (JCGT 8(2) 2019, sec. 4.3). 100 is
/// about as wide as a texel of the default tile and leaks less than half as much (brightest spot
/// behind a closed wall, probes 1 m apart: 3.9 % of the room's light with the door open,
/// against 9.1 %); 200 gains nothing.
const float kDistanceExponent = 100.0f;

/// A probe that sees more back faces than this share of its rays stands in solid matter and is to
/// light nothing. JCGT 10(2) 2021, sec. 4.
const float kBackFaceThreshold = 0.25f;

// A ray that meets the back of a single-sided surface counts as shortened to this share, so that a
// probe inside something trusts its surroundings little. JCGT 10(2) 2021, sec. 4.
const float kBackFaceDistanceScale = 0.2f;

/// The distance that a ray counts with [m], of one that saw so far (infinite: out of the scene).
LAMBENT_FN float counted_distance(float seen, uint back_face, float farthest) {
  float cut = min(seen, farthest);
  return back_face != 0u ? cut * kBackFaceDistanceScale : cut;
}

LAMBENT_FN uint is_inside_geometry(int back_faces, int rays) {
  return float(back_faces) > kBackFaceThreshold * float(rays) ? 1u : 0u;
}

// Texels whose rays count for less than this share of all are too few to tell anything.
const float kMinKnownWeight = 1e-4f;
// Keeps the division by the weights of a texel for which no ray counts finite.
const float kTiniestWeight = 1e-20f;

/// Irradiance at a texel's centre, from sums of radiance * cosine and of cosines over the rays that
/// count: the mean radiance, weighted by the cosine, times pi.
LAMBENT_FN vec3 irradiance_at_centre(vec4 sums) {
  return vec3(sums) * (kPi / max(sums.w, kTiniestWeight));
}

LAMBENT_END
#endif
