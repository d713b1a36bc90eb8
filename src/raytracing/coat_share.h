// SPDX-License-Identifier: Apache-2.0
// Which light a coat reflects by rays of its own (src/glossy), and which it has from elsewhere, so
// that every path of light counts once.
//
// Light that is not an emitter's reaches a coat by its rays, or else by the field. An emitter's
// also comes with the direct light, which samples emitters: the two estimates of it are combined by
// weights that sum to 1 for each direction.
#ifndef LAMBENT_RAYTRACING_COAT_SHARE_H
#define LAMBENT_RAYTRACING_COAT_SHARE_H

#include "shared/brdf.h"

LAMBENT_BEGIN

// Coats up to the first roughness have rays of their own, those from the second on reflect the
// field's light along the mirror direction; in between a share of each, so that nobody sees where.
// The lobe of the second is about as wide as the cosine's, with which the field's light is blurred.
const float kLastTracedRoughness = 0.75f;
const float kFirstCachedRoughness = 0.95f;

// Density with which one sample of emitters is taken to be drawn [1/sr]: that of a lamp which
// subtends a tenth of a steradian. Coats whose own rays are denser towards the lamp than all of its
// samples see it in these. It decides over noise alone: the weights sum to 1 whatever it is.
const float kEmitterDensity = 10.0f;

/// Shares of the coat's and the clearcoat's light that rays of their own bring.
struct CoatShares {
  float coat;
  float clearcoat;
};

/// Share of a coat's light that rays of its own bring, 0 to 1; of a clearcoat as of a coat, see
/// clearcoat_alone()
LAMBENT_FN float traced_coat_share(Reflectance surface) {
  if (surface.f90 <= 0.0f) return 0.0f;
  float roughness = sqrt(surface.alpha);
  float t =
      clamp((kFirstCachedRoughness - roughness) / (kFirstCachedRoughness - kLastTracedRoughness),
            0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Weight of an emitter that a coat's ray found, drawn with density `pdf` [1/sr], where its direct
/// light takes so many samples of emitters. The power heuristic (Veach 1997, sec. 9.2) against a
/// density that stands for that of the sampling: weights need not be of the true densities for sums
/// without bias.
LAMBENT_FN float found_emitter_weight(float pdf, uint emitter_samples) {
  return pdf > 0.0f ? mis_power_weight(pdf, kEmitterDensity * float(emitter_samples)) : 0.0f;
}

/// Weight of an emitter's sample in a coat's direct light, where rays bring `coat_share` of the
/// coat's light. Directions are in the frame of the normal.
LAMBENT_FN float sampled_emitter_weight(Reflectance surface, vec3 to_viewer, vec3 to_light,
                                        float coat_share, uint emitter_samples) {
  if (coat_share <= 0.0f) return 1.0f;
  float pdf = pdf_ggx_reflection(to_viewer, to_light, surface.alpha);
  return 1.0f - coat_share * found_emitter_weight(pdf, emitter_samples);
}

/// The same of a surface's clearcoat.
LAMBENT_FN float sampled_emitter_weight(SurfaceLayers layers, vec3 to_viewer, vec3 to_light,
                                        float coat_share, uint emitter_samples) {
  if (coat_share <= 0.0f) return 1.0f;
  float pdf = pdf_clearcoat(layers, to_viewer, to_light);
  return 1.0f - coat_share * found_emitter_weight(pdf, emitter_samples);
}

LAMBENT_END
#endif
