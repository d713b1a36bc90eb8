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

// Samples of emitters and rays of coats both find lamps. Where a lobe is denser towards a lamp than
// the samples, its rays estimate the lamp's light. The weights sum to 1 whatever density is assumed
// for the samples, which affects noise alone. Where it is assumed too large, samples have to
// estimate what they seldom find: bright specks.

// Samples of emitters are this many times as dense as if lights in all directions were picked by
// what they send: half of them are below a surface's horizon, and resampling prefers those that its
// lobes reflect, by about as much. With 1, noise of narrow lobes is about the same, and rough ones
// have so much of their light by rays that reuse on every second row loses 2 % of it between walls
// that shine.
const float kSampleDensityFactor = 4.0f;

/// Factor from emission_luminance() of an emitter to the density with which `samples` samples of
/// emitters find it [m^2/W]. Lights are picked about in proportion to what they send. `fluence`:
/// what all of them send to the place; see fluence() of light_tree.inl.h [W/m^2]. Where it is 0,
/// samples find nothing.
LAMBENT_FN float emitter_density_scale(uint samples, float fluence) {
  return fluence > 0.0f ? kSampleDensityFactor * float(samples) / fluence : 0.0f;
}

/// Weight of a sample of emitters of this density in a coat's direct light, where rays supply the
/// share `coat_share` of the coat's light. Directions are in the frame of the normal.
LAMBENT_FN float sampled_emitter_weight(Reflectance surface, vec3 to_viewer, vec3 to_light,
                                        float coat_share, float density) {
  if (coat_share <= 0.0f) return 1.0f;
  float pdf = pdf_ggx_reflection(to_viewer, to_light, surface.alpha);
  return 1.0f - coat_share * found_light_weight(pdf, density);
}

/// The same for a surface's clearcoat.
LAMBENT_FN float sampled_emitter_weight(SurfaceLayers layers, vec3 to_viewer, vec3 to_light,
                                        float coat_share, float density) {
  if (coat_share <= 0.0f) return 1.0f;
  float pdf = pdf_clearcoat(layers, to_viewer, to_light);
  return 1.0f - coat_share * found_light_weight(pdf, density);
}

LAMBENT_END
#endif
