// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019; Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global
// Illumination for Production", JCGT 10(2), 2021. The weights of the eight probes around a point.
#ifndef LAMBENT_FIELD_LOOKUP_LOOKUP_H
#define LAMBENT_FIELD_LOOKUP_LOOKUP_H

#include "field/probes/probe_grid.h"

LAMBENT_BEGIN

// Visibility is evaluated at a biased position, off the surface along the normal and towards the
// viewer by kBiasScale * kBias * (smallest probe spacing). That is far enough that the surface does
// not shadow itself in statistics as coarse as a tile's texels, but not so far that it passes
// through a thin wall. JCGT 2021, sec. 3: 0.2, 0.8, 0.75 and B = 0.3.
const float kNormalBias = 0.2f;
const float kViewBias = 0.8f;
const float kBiasScale = 0.75f;
const float kBias = 0.3f;

// Probes behind a surface count less, the larger the negative cosine, and nothing from this one on.
// The published value is 1 (JCGT 8(2) 2019). Where probes stand just in front of both sides of a
// thin wall, those of the far side then count too much: behind a closed wall, 1.0 % of the open
// door's light, against 0.14 %. A smaller value costs accuracy.
const float kWrapCosine = 0.5f;

// Weights below this threshold fall off with the cube, so that nearly hidden probes fade out
// instead of leaking light.
const float kCrushThreshold = 0.2f;

// The least weight of a probe. Where every probe seems hidden, trilinear interpolation alone
// decides.
const float kMinVisibilityWeight = 1e-6f;

// The least distance between a point and a probe [m]. It keeps the direction between them finite
// where both are at the same place.
const float kMinProbeDistance = 1e-6f;

// Where the volumes so far leave less than this weight, the rest is rounding.
const float kNothingLeft = 1e-6f;

/// The point at which visibility is evaluated.
LAMBENT_FN vec3 biased_position(vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                                float spacing_min) {
  return position_ws +
         (kNormalBias * normal_ws + kViewBias * to_viewer_ws) * (kBiasScale * kBias * spacing_min);
}

/// Visibility over a distance, from the mean and the mean square of the distances to occluders.
/// Chebyshev's one-sided inequality gives an upper bound on the fraction of light paths that are
/// not blocked (Donnelly and Lauritzen, "Variance Shadow Maps", I3D 2006, Eq. 5). Its cube (JCGT
/// 10(2) 2021) is no longer a bound, but darkens leaks: behind a closed wall, their mean falls
/// from 5.0 % to 0.4 %.
LAMBENT_FN float chebyshev_visibility(vec2 moments, float dist) {
  float beyond = dist - moments.x;
  if (beyond <= 0.0f) return 1.0f;
  float variance = abs(moments.y - moments.x * moments.x);
  float bound = variance / (variance + beyond * beyond);
  return bound * bound * bound;
}

/// The wrap-shading weight of a probe: 1 straight in front of the surface, falling off smoothly
/// towards its back. `cos_probe` is the cosine between the surface normal and the direction to the
/// probe. The published weight adds a floor of 0.2, which lets light through thin sheets and costs
/// accuracy.
LAMBENT_FN float wrap_weight(float cos_probe) {
  float wrap = max(0.0f, (cos_probe + kWrapCosine) / (1.0f + kWrapCosine));
  return wrap * wrap;
}

/// The weight of a probe before trilinear interpolation, from its wrap-shading weight and
/// visibility.
LAMBENT_FN float combined_weight(float wrap, float visibility) {
  float weight = wrap * visibility;
  if (weight < kCrushThreshold) weight *= weight * weight / (kCrushThreshold * kCrushThreshold);
  return max(weight, kMinVisibilityWeight);
}

/// The weight of a probe before trilinear interpolation, from the cosine as for wrap_weight() and
/// from the stored distances. A probe inside geometry holds a mean distance of 0. It has no light
/// and no weight, even where all other probes are hidden.
LAMBENT_FN float probe_weight(float cos_probe, vec2 moments, float dist) {
  float weight = combined_weight(wrap_weight(cos_probe), chebyshev_visibility(moments, dist));
  return moments.x > 0.0f ? weight : 0.0f;
}

LAMBENT_END
#endif
