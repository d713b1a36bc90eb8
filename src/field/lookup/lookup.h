// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019; Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global
// Illumination for Production", JCGT 10(2), 2021. How much each of the eight probes around a point
// counts.
#ifndef LAMBENT_FIELD_LOOKUP_LOOKUP_H
#define LAMBENT_FIELD_LOOKUP_LOOKUP_H

#include "field/probes/probe_grid.h"

LAMBENT_BEGIN

// The point at which visibility is asked is moved off the surface, along the normal and towards the
// viewer, by kBiasScale * kBias * (smallest probe spacing): far enough that the surface does not
// shadow itself in statistics as coarse as a tile's texels, not so far that it passes a thin wall.
// JCGT 2021, sec. 3: 0.2, 0.8, 0.75 and B = 0.3.
const float kNormalBias = 0.2f;
const float kViewBias = 0.8f;
const float kBiasScale = 0.75f;
const float kBias = 0.3f;

// Probes behind a surface count less the farther behind, and nothing from this negative cosine on.
// Published: 1 (JCGT 8(2) 2019). Where probes stand just in front of both sides of a thin wall,
// those of the other side then count too much: behind a closed wall, 1.0 % of the open door's
// light, against 0.14 %; less costs accuracy.
const float kWrapCosine = 0.5f;

// Weights below this fall off with the cube, so that nearly hidden probes fade out rather than
// leak.
const float kCrushThreshold = 0.2f;

// Where every probe seems hidden, trilinear interpolation decides among them.
const float kMinVisibilityWeight = 1e-6f;

// Where a point is at a probe's own place, no direction leads from the one to the other: directions
// are divided by no less than this [m].
const float kMinProbeDistance = 1e-6f;

// What no volume has answered for yet below this share is rounding.
const float kNothingLeft = 1e-6f;

/// The point at which visibility is asked.
LAMBENT_FN vec3 biased_position(vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                                float spacing_min) {
  return position_ws +
         (kNormalBias * normal_ws + kViewBias * to_viewer_ws) * (kBiasScale * kBias * spacing_min);
}

/// An upper bound on the share of light paths of length `dist` that are not blocked, from the mean
/// and the mean square of the distance to what blocks them. Chebyshev's one-sided inequality;
/// Donnelly and Lauritzen, "Variance Shadow Maps", I3D 2006, Eq. 5. Its cube (JCGT 10(2) 2021) is
/// no bound any more, but darkens what leaks: behind a closed wall, mean 5.0 % to 0.4 %.
LAMBENT_FN float chebyshev_visibility(vec2 moments, float dist) {
  float beyond = dist - moments.x;
  if (beyond <= 0.0f) return 1.0f;
  float variance = abs(moments.y - moments.x * moments.x);
  float bound = variance / (variance + beyond * beyond);
  return bound * bound * bound;
}

/// Weight of a probe by its side of the surface: 1 straight in front, falling off smoothly.
/// `cos_probe` is the cosine between the surface normal and the direction to the probe. The
/// published weight adds a floor of 0.2, which lets light through sheets and costs accuracy.
LAMBENT_FN float wrap_weight(float cos_probe) {
  float wrap = max(0.0f, (cos_probe + kWrapCosine) / (1.0f + kWrapCosine));
  return wrap * wrap;
}

/// Weight of a probe before trilinear interpolation, from its weight by its side of the surface and
/// from its visibility.
LAMBENT_FN float combined_weight(float wrap, float visibility) {
  float weight = wrap * visibility;
  if (weight < kCrushThreshold) weight *= weight * weight / (kCrushThreshold * kCrushThreshold);
  return max(weight, kMinVisibilityWeight);
}

/// The same from the cosine as above and the stored distances. A probe inside solid matter holds a
/// mean distance of 0: it knows nothing of light and counts for nothing, even where the others are
/// hidden.
LAMBENT_FN float probe_weight(float cos_probe, vec2 moments, float dist) {
  float weight = combined_weight(wrap_weight(cos_probe), chebyshev_visibility(moments, dist));
  return moments.x > 0.0f ? weight : 0.0f;
}

LAMBENT_END
#endif
