// SPDX-License-Identifier: Apache-2.0
// Where samples of a pixel lie, what its surface makes of light, and the layers that it shows.
#ifndef LAMBENT_COMPOSE_PIXEL_MATH_H
#define LAMBENT_COMPOSE_PIXEL_MATH_H

#include "glossy/glossy_math.h"
#include "raytracing/shaded_hit.h"
#include "scene/coverage.h"
#include "shared/brdf.h"
#include "shared/demodulate.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "temporal/taa_math.h"

LAMBENT_BEGIN

// Keeps the random numbers of pixels' positions apart from those of other passes.
const uint kSubpixelSalt = 0x50495845u;

/// Where in its pixel a sample of so many lies, each coordinate 0 to 1. It is the same place in all
/// pixels: along an edge all of them then see the same share of both sides, where places of their
/// own would make few samples a row of light and dark beads.
LAMBENT_FN vec2 subpixel_position(uint index, uint samples, uint seed) {
  if (samples == 1u) return vec2(0.5f);
  RandomStream random = make_random_stream(0u, kSubpixelSalt, seed);
  vec2 shift = next_uniform2(random);
  return fract(shift + plastic_sequence(index));
}

/// The number of a sample among all that its pixel has had. In sequences that are anti-aliased over
/// time, numbers go on from frame to frame: `jitter` is 1 + the frames before. 0: each frame counts
/// from 0.
LAMBENT_FN uint sample_number(uint index, uint samples, uint jitter) {
  return jitter == 0u ? index : (jitter - 1u) * samples + index;
}

/// Where in its pixel a frame's sample lies, as subpixel_position() above. In sequences that are
/// anti-aliased over time, places go on from frame to frame; `jitter` as of sample_number().
LAMBENT_FN vec2 subpixel_position(uint index, uint samples, uint seed, uint jitter) {
  if (jitter == 0u) return subpixel_position(index, samples, seed);
  return jitter_position(sample_number(index, samples, jitter));
}

/// Share of a pixel's indirect irradiance that counts. Lookups of the field know nothing of the
/// geometric horizon; gathered light and that of shadow maps have left out what is below it.
LAMBENT_FN float indirect_share(float gi_share, uint looked_up) {
  if (looked_up != 0u) return gi_share;
  return gi_share > 0.0f ? 1.0f : 0.0f;
}

/// Direct light of emitters as it is filtered [W/(m^2 sr)].
struct FilteredEmitter {
  vec3 light;     ///< Without albedo, over the level.
  vec3 albedo;    ///< What comes of filtered light to the viewer: albedo times level.
  float level;    ///< As of filtered_level.
  float inverse;  ///< One over it.
};

/// `reflected`: what was found, with albedo. `unoccluded`: as of filtered_level.
LAMBENT_FN FilteredEmitter filtered_emitter(Reflectance surface, vec3 reflected, float unoccluded) {
  vec3 albedo = filtered_albedo(surface);
  vec3 found = reflected / albedo;
  float level = filtered_level(unoccluded, luminance(found));
  float inverse = inverse_level(level);
  FilteredEmitter filtered = {inverse * found, level * albedo, level, inverse};
  return filtered;
}

/// The variance of such light's luminance where that of what was found, without albedo, is this.
LAMBENT_FN float filtered_variance(FilteredEmitter emitter, float variance) {
  // The square of the inverse may be more than floats hold
  return emitter.inverse * (emitter.inverse * variance);
}

/// The albedo without which light that a coat reflects by rays is filtered, where these bring
/// `coat_share` of its light.
LAMBENT_FN vec3 filtered_coat_albedo(Reflectance surface, float n_dot_v, float coat_share) {
  vec3 albedo = specular_albedo(coat_under_layers(surface, n_dot_v), n_dot_v);
  return coat_share * max(albedo, vec3(kLeastFilteredAlbedo));
}

/// The albedo without which light of a coat behind glass is filtered: with the share of it that the
/// way brings to the pixel.
LAMBENT_FN vec3 coat_albedo_behind(CoatPath path, Reflectance surface, float n_dot_v) {
  return max(path.throughput, vec3(kLeastFilteredAlbedo)) *
         filtered_coat_albedo(surface, n_dot_v, 1.0f);
}

// A clearcoat whose normal makes at least this cosine with the base's has the same: 0.8 degrees.
const float kSameNormalCosine = 0.9999f;

// Lamps in lobes up to this GGX width, of roughness 0.05, are found by rays of the coat: little of
// what samples of emitters bring is theirs.
const float kFoundByRaysAlpha = 0.0025f;

/// GGX width of the narrowest lobe with which a surface reflects what samples of emitters bring,
/// around its shading normal; 0 where its clearcoat has another normal.
LAMBENT_FN float highlight_alpha(Reflectance surface) {
  if (!has_clearcoat(surface.layers)) return surface.alpha;
  if (surface.layers.clearcoat_alpha <= kFoundByRaysAlpha) return surface.alpha;
  if (surface.layers.clearcoat_normal.z < kSameNormalCosine) return 0.0f;
  return min(surface.alpha, surface.layers.clearcoat_alpha);
}

/// Whether light that a clearcoat of this GGX width reflects by rays is filtered. Narrower lobes
/// have little noise, and show what neighbours do not see.
LAMBENT_FN bool is_filtered_clearcoat(float alpha) {
  return alpha > kFoundByRaysAlpha;
}

/// GGX width of the lobe over which light of a coat behind glass is filtered. 0, which is not at
/// all, where no ray of the coat tells how far away the things are that it shows.
LAMBENT_FN float alpha_behind(Reflectance surface, float coat_share) {
  return coat_share > 0.0f ? highlight_alpha(surface) : 0.0f;
}

/// The field's light at a pixel once another source has taken the place of a part of it.
LAMBENT_FN vec3 replaced_light(vec3 irradiance, vec3 added, vec3 subtracted_field) {
  return max(irradiance + added - subtracted_field, vec3(0.0f));
}

LAMBENT_END
#endif
