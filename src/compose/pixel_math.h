// SPDX-License-Identifier: Apache-2.0
// Sample positions in a pixel, demodulation of its light for the filter, and blend factors.
#ifndef LAMBENT_COMPOSE_PIXEL_MATH_H
#define LAMBENT_COMPOSE_PIXEL_MATH_H

#include "glossy/path_math.h"
#include "raytracing/shaded_hit.h"
#include "scene/coverage.h"
#include "shared/brdf.h"
#include "shared/demodulate.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "temporal/taa_math.h"

LAMBENT_BEGIN

// Makes the random numbers of sample positions independent of those of other passes.
const uint kSubpixelSalt = 0x50495845u;

/// Position of one of `samples` samples in its pixel, each coordinate 0 to 1. It is the same in all
/// pixels: all pixels along an edge then show the same share of both sides, where a position of
/// each pixel's own would turn the edge into a row of light and dark beads at few samples.
LAMBENT_FN vec2 subpixel_position(uint index, uint samples, uint seed) {
  if (samples == 1u) return vec2(0.5f);
  RandomStream random = make_random_stream(0u, kSubpixelSalt, seed);
  vec2 shift = next_uniform2(random);
  return fract(shift + plastic_sequence(index));
}

/// The seed by which a round's samples, from `first` on, are stratified at see-through surfaces;
/// see SampleRound.
LAMBENT_FN uint round_seed(uint seed, uint first) {
  return first == 0u ? seed : hash_pcg(seed + first);
}

/// The number of a sample among all that its pixel has had. Under temporal anti-aliasing, numbers
/// continue from frame to frame: `jitter` is 1 + the number of previous frames. 0: each frame
/// counts from 0.
LAMBENT_FN uint sample_number(uint index, uint samples, uint jitter) {
  return jitter == 0u ? index : (jitter - 1u) * samples + index;
}

/// Position of a frame's sample in its pixel, see above. Under temporal anti-aliasing, positions
/// continue from frame to frame; `jitter`: see sample_number().
LAMBENT_FN vec2 subpixel_position(uint index, uint samples, uint seed, uint jitter) {
  if (jitter == 0u) return subpixel_position(index, samples, seed);
  return jitter_position(sample_number(index, samples, jitter));
}

/// Factor of a pixel's indirect irradiance. Lookups of the field ignore the geometric horizon,
/// hence gi_share; gathered light and that of shadow maps already leave out what is below it.
LAMBENT_FN float indirect_share(float gi_share, uint looked_up) {
  if (looked_up != 0u) return gi_share;
  return gi_share > 0.0f ? 1.0f : 0.0f;
}

/// Direct light of emitters in the form in which it is filtered [W/(m^2 sr)].
struct FilteredEmitter {
  vec3 light;   ///< Divided by albedo, level and tint.
  vec3 albedo;  ///< Factor from filtered light to radiance: albedo times level and tint.
  float level;  ///< See filtered_level().
  float found;  ///< Luminance of the sampled light without albedo.
  float scale;  ///< Luminance of `light` over `found`; 0 where there is no light.
};

/// `reflected`: the sampled light, with albedo. `unoccluded`: that of unoccluded_light().
LAMBENT_FN FilteredEmitter filtered_emitter(Reflectance surface, vec3 reflected, vec3 unoccluded) {
  vec3 albedo = filtered_albedo(surface);
  vec3 found = reflected / albedo;
  vec3 tint = unoccluded_tint(unoccluded);
  float whitened = luminance(found / tint);
  float level = filtered_level(luminance(unoccluded), whitened);
  float inverse = inverse_level(level);
  float whole = luminance(found);
  float scale = whole > kLeastFilteredLevel ? inverse * (whitened / whole) : inverse;
  FilteredEmitter filtered = {inverse * found / tint, level * tint * albedo, level, whole, scale};
  return filtered;
}

/// Variance of the luminance of `emitter.light`, given that of the sampled light over its albedo.
LAMBENT_FN float filtered_variance(FilteredEmitter emitter, float variance) {
  // The square of the scale may exceed the range of floats
  return emitter.scale * (emitter.scale * variance);
}

/// The surface that a path from a pixel has hit, without the light of emitters. `viewer_distance`:
/// length of the path's last segment [m]. `gathers`: rays gather its light.
LAMBENT_FN ShownBase shown_base(vec3 position_ws, vec3 normal_ws, vec3 geometric_normal_ws,
                                float gi_share, Reflectance surface, vec3 to_viewer_ws,
                                float viewer_distance, CoatPath path, bool gathers) {
  ShownBase base = no_shown_base();
  base.position_ws = position_ws;
  base.normal_ws = normal_ws;
  base.shown = 1u;
  base.gi_share = gi_share;
  base.geometric_normal_ws = geometric_normal_ws;
  base.viewer_distance = viewer_distance;
  base.to_viewer_ws = to_viewer_ws;
  if (!gathers || gi_share <= 0.0f) return base;
  base.indirect_albedo =
      path.throughput * reflected_indirect(surface, dot(normal_ws, to_viewer_ws), vec3(1.0f));
  return base;
}

/// Adds the light of emitters to that record. `variance`: see filtered_variance().
LAMBENT_FN void add_emitters(FilteredEmitter emitter, float variance, CoatPath path,
                             LAMBENT_INOUT(ShownBase) base) {
  base.level = emitter.level;
  base.variance = filtered_variance(emitter, variance);
  base.light = emitter.light;
  base.emitter_albedo = path.throughput * emitter.albedo;
}

/// FilteredCoats::variance of filtered light of a coat.
LAMBENT_FN float variance_of_ray(CoatGuide guide, vec3 light) {
  float level = luminance(light);
  return guide.ray_variance * level * level;
}

/// The light of a coat that is filtered apart from its excess. Rounding may make the excess the
/// larger of the two.
LAMBENT_FN vec3 without_excess(vec3 light, vec3 excess) {
  return max(light - excess, vec3(0.0f));
}

/// The albedo that the light of a coat behind glass is divided by before it is filtered. It
/// includes the path's throughput to the pixel.
LAMBENT_FN vec3 coat_albedo_behind(CoatPath path, Reflectance surface, float n_dot_v) {
  return max(path.throughput, vec3(kLeastFilteredAlbedo)) *
         filtered_coat_albedo(surface, n_dot_v, 1.0f);
}

// A clearcoat's normal is taken to be the base's where their cosine is at least this: 0.8 degrees.
const float kSameNormalCosine = 0.9999f;

// Coats up to this GGX width, of roughness 0.05, find lamps by their rays: samples of emitters
// contribute little to their light.
const float kFoundByRaysAlpha = 0.0025f;

/// GGX width of the narrowest lobe around the shading normal in which a surface reflects samples of
/// emitters; 0 where its clearcoat has another normal.
LAMBENT_FN float highlight_alpha(Reflectance surface) {
  if (!has_clearcoat(surface.layers)) return surface.alpha;
  if (surface.layers.clearcoat_alpha <= kFoundByRaysAlpha) return surface.alpha;
  if (surface.layers.clearcoat_normal.z < kSameNormalCosine) return 0.0f;
  return min(surface.alpha, surface.layers.clearcoat_alpha);
}

/// Whether light that a clearcoat of this GGX width reflects from rays is filtered. Narrower lobes
/// have little noise, and reflect what neighbours do not.
LAMBENT_FN bool is_filtered_clearcoat(float alpha) {
  return alpha > kFoundByRaysAlpha;
}

/// GGX width of the lobe over which the light of a coat behind glass is filtered. 0, which is not
/// at all, where no ray of the coat measures the distance to what it reflects.
LAMBENT_FN float alpha_behind(Reflectance surface, float coat_share) {
  return coat_share > 0.0f ? highlight_alpha(surface) : 0.0f;
}

LAMBENT_END
#endif
