// SPDX-License-Identifier: Apache-2.0
// The phase function of fog: the distribution of scattered light over directions.
// Based on: Henyey and Greenstein, "Diffuse Radiation in the Galaxy", Astrophysical Journal 93,
// 1941.
#ifndef LAMBENT_SHARED_PHASE_H
#define LAMBENT_SHARED_PHASE_H

#include "shared/constants.h"

LAMBENT_BEGIN

/// The phase function of Henyey and Greenstein 1941 [1/sr]: the density of scattering by an angle,
/// given the cosine between the directions of light before and after.
LAMBENT_FN float phase(float anisotropy, float cosine) {
  float squared = anisotropy * anisotropy;
  float base = max(1.0f + squared - 2.0f * anisotropy * cosine, 0.0f);
  return (1.0f - squared) / (4.0f * kPi * base * sqrt(base));
}

// Anisotropy below which light is scattered evenly: the inverse of the distribution divides by it.
const float kLeastAnisotropy = 1e-3f;

/// The cosine of the scattering angle for a uniform number; its density is phase().
LAMBENT_FN float sample_phase(float anisotropy, float u) {
  if (abs(anisotropy) < kLeastAnisotropy) return 1.0f - 2.0f * u;
  float ratio = (1.0f - anisotropy * anisotropy) / (1.0f - anisotropy + 2.0f * anisotropy * u);
  return clamp((1.0f + anisotropy * anisotropy - ratio * ratio) / (2.0f * anisotropy), -1.0f, 1.0f);
}

/// The uniform number for which sample_phase gives a cosine.
LAMBENT_FN float invert_phase(float anisotropy, float cosine) {
  if (abs(anisotropy) < kLeastAnisotropy) return 0.5f * (1.0f - cosine);
  float root = sqrt(1.0f + anisotropy * anisotropy - 2.0f * anisotropy * cosine);
  return ((1.0f - anisotropy * anisotropy) / root - 1.0f + anisotropy) / (2.0f * anisotropy);
}

LAMBENT_END
#endif
