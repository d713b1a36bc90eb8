// SPDX-License-Identifier: Apache-2.0
// Demodulation: filters see light divided by the albedo of the surface and, for direct light of
// emitters, by the unoccluded light.
#ifndef LAMBENT_SHARED_DEMODULATE_H
#define LAMBENT_SHARED_DEMODULATE_H

#include "shared/brdf.h"
#include "shared/color.h"

LAMBENT_BEGIN

// Least albedo by which reflected light is divided before filtering, and multiplied again
// afterwards.
const float kLeastFilteredAlbedo = 1e-3f;

/// The albedo by which a surface's direct light of emitters is divided before filtering.
LAMBENT_FN vec3 filtered_albedo(Reflectance reflectance) {
  return max(reflectance.diffuse + reflectance.layers.sheen, vec3(kLeastFilteredAlbedo));
}

// Largest trusted ratio of light sampled with few rays to the unoccluded light, which is accurate
// to a few percent. Beyond it, the level follows the sampled light.
const float kMostOverUnoccluded = 8.0f;

/// The level by which direct light of emitters, without albedo, is divided before it is filtered:
/// the unoccluded luminance. The filter then sees the unoccluded share alone, and preserves
/// gradients near lights. `light` is the sampled luminance, also over the tint. Heitz, Hill and
/// McGuire, "Combining Analytic Direct Illumination and Stochastic Shadows", I3D 2018, which also
/// filters occluded over unoccluded light.
LAMBENT_FN float filtered_level(float unoccluded, float light) {
  return max(unoccluded, light / kMostOverUnoccluded);
}

// Lower levels are rounding errors, where a lamp is just above the horizon, and count as no light:
// their inverse may overflow.
const float kLeastFilteredLevel = 1e-30f;

// Least tint of a channel: the colours of lights are means, and single samples may have more of it.
const float kMinTint = 1.0f / 64.0f;

/// The colour of unoccluded light over its luminance, by which direct light of emitters is divided,
/// too. The filter takes the unoccluded share of all lamps for the same; where lamps differ in
/// colour, it would mix these colours otherwise.
LAMBENT_FN vec3 unoccluded_tint(vec3 unoccluded) {
  float whole = luminance(unoccluded);
  return whole > kLeastFilteredLevel ? max(unoccluded / whole, vec3(kMinTint)) : vec3(1.0f);
}

/// One over a level; 0 where there is no light.
LAMBENT_FN float inverse_level(float level) {
  return level > kLeastFilteredLevel ? 1.0f / level : 0.0f;
}

LAMBENT_END
#endif
