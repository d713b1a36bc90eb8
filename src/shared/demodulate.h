// SPDX-License-Identifier: Apache-2.0
// Light without the colour of the surface that reflects it, and back again.
#ifndef LAMBENT_SHARED_DEMODULATE_H
#define LAMBENT_SHARED_DEMODULATE_H

#include "shared/brdf.h"

LAMBENT_BEGIN

// Albedo by which reflected light is divided, and the filtered light multiplied again, is never
// less: what darker channels reflect is filtered as it is.
const float kLeastFilteredAlbedo = 1e-3f;

/// The albedo without which a surface's direct light of emitters is filtered.
LAMBENT_FN vec3 filtered_albedo(Reflectance reflectance) {
  return max(reflectance.diffuse + reflectance.layers.sheen, vec3(kLeastFilteredAlbedo));
}

// Light that few rays found may be this many times what arrives where nothing is in the way, which
// is known within a few percent, before that is not believed any more.
const float kMostOverUnoccluded = 8.0f;

/// The level by which direct light of emitters, without albedo, is divided before it is filtered:
/// the luminance that arrives where nothing is in the way. What is filtered is then what is not
/// occluded, and gradients near lights stay as they are. `light`: luminance that was found.
/// Heitz, Hill and McGuire, "Combining Analytic Direct Illumination and Stochastic Shadows", I3D
/// 2018, which also filters occluded over unoccluded light.
LAMBENT_FN float filtered_level(float unoccluded, float light) {
  return max(unoccluded, light / kMostOverUnoccluded);
}

// Lower levels are rounding, where a lamp is just above the horizon, and count as no light: one
// over them may be more than floats hold.
const float kLeastFilteredLevel = 1e-30f;

/// One over a level; 0 where there is no light.
LAMBENT_FN float inverse_level(float level) {
  return level > kLeastFilteredLevel ? 1.0f / level : 0.0f;
}

LAMBENT_END
#endif
