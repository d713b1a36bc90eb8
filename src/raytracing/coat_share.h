// SPDX-License-Identifier: Apache-2.0
// How a coat's light is split between rays of its own (src/glossy) and other sources, so that every
// path of light counts once.
//
// Light other than emission and the bright part of the sky reaches a coat by its rays, or else by
// the field. These two are also part of the direct light, which samples emitters and the sky:
// multiple importance sampling combines the two estimates with weights that sum to 1 for each
// direction.
#ifndef LAMBENT_RAYTRACING_COAT_SHARE_H
#define LAMBENT_RAYTRACING_COAT_SHARE_H

#include "shared/brdf.h"

LAMBENT_BEGIN

// Coats up to the first roughness have rays of their own. Those from the second on reflect the
// field's light along the mirror direction. Between them, both have a share, so that the transition
// is invisible. The second's lobe is about as wide as the cosine lobe that blurs the field's light.
const float kLastTracedRoughness = 0.75f;
const float kFirstCachedRoughness = 0.95f;

// Assumed density of one sample of emitters [1/sr]: that of a lamp which subtends a tenth of a
// steradian. Where a coat's lobe is denser towards a lamp than all samples together, its rays
// estimate the lamp's light. The value affects noise alone: the weights sum to 1 whatever it is.
const float kEmitterDensity = 10.0f;

/// Shares of the coat's and the clearcoat's light that come from rays of their own.
struct CoatShares {
  float coat;
  float clearcoat;
};

/// Share of a coat's light that comes from rays of its own, 0 to 1. For clearcoats, pass the result
/// of clearcoat_alone().
LAMBENT_FN float traced_coat_share(Reflectance surface) {
  if (surface.f90 <= 0.0f) return 0.0f;
  float roughness = sqrt(surface.alpha);
  float t =
      clamp((kFirstCachedRoughness - roughness) / (kFirstCachedRoughness - kLastTracedRoughness),
            0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// At pixels, gathered light reaches the base of a surface alone. Rough metals have no base, and the
// field's light on their coats would show its cells. So a coat that reflects most of a surface's
// light, kFirstMajorCoat of it or more at normal incidence, has rays whatever its roughness. For a
// coat of kLastMinorCoat or less, roughness alone decides; between the two the share is linear.
const float kLastMinorCoat = 0.5f, kFirstMajorCoat = 0.9f;

/// Share of the light of a pixel's coat that comes from rays of its own, 0 to 1.
LAMBENT_FN float pixel_coat_share(Reflectance surface) {
  if (surface.f90 <= 0.0f) return 0.0f;
  float coat = luminance(surface.f0);
  float both = coat + luminance(surface.diffuse);
  float major = both > 0.0f ? coat / both : 0.0f;
  return max(traced_coat_share(surface),
             clamp((major - kLastMinorCoat) / (kFirstMajorCoat - kLastMinorCoat), 0.0f, 1.0f));
}

/// The shares at a pixel's surface.
LAMBENT_FN CoatShares pixel_coat_shares(Reflectance surface) {
  CoatShares shares = {pixel_coat_share(surface), 0.0f};
  if (has_clearcoat(surface.layers)) {
    shares.clearcoat = traced_coat_share(clearcoat_alone(surface.layers));
  }
  return shares;
}

/// Density with which `emitter_samples` samples of emitters are taken to find one [1/sr].
LAMBENT_FN float emitter_density(uint emitter_samples) {
  return kEmitterDensity * float(emitter_samples);
}

/// Weight of an emitter that a coat's ray hit, where the direct light takes `emitter_samples`
/// samples: found_light_weight() with an assumed density in place of that of the sampling.
LAMBENT_FN float found_emitter_weight(float pdf, uint emitter_samples) {
  return found_light_weight(pdf, emitter_density(emitter_samples));
}

/// Weight of a sample of emitters in a coat's direct light, where rays supply the share
/// `coat_share` of the coat's light. Directions are in the frame of the normal.
LAMBENT_FN float sampled_emitter_weight(Reflectance surface, vec3 to_viewer, vec3 to_light,
                                        float coat_share, uint emitter_samples) {
  if (coat_share <= 0.0f) return 1.0f;
  float pdf = pdf_ggx_reflection(to_viewer, to_light, surface.alpha);
  return 1.0f - coat_share * found_emitter_weight(pdf, emitter_samples);
}

/// The same for a surface's clearcoat.
LAMBENT_FN float sampled_emitter_weight(SurfaceLayers layers, vec3 to_viewer, vec3 to_light,
                                        float coat_share, uint emitter_samples) {
  if (coat_share <= 0.0f) return 1.0f;
  float pdf = pdf_clearcoat(layers, to_viewer, to_light);
  return 1.0f - coat_share * found_emitter_weight(pdf, emitter_samples);
}

LAMBENT_END
#endif
