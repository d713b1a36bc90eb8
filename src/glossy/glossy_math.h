// SPDX-License-Identifier: Apache-2.0
// Rays that coats send out, what they bring, and what a coat makes of the rays around it.
//
// Based on: Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018; Stachowiak,
// "Stochastic Screen-Space Reflections", SIGGRAPH courses 2015 (rays of neighbours, each with the
// weight of the pixel's own lobe); Karis, "Real Shading in Unreal Engine 4", SIGGRAPH courses 2013
// (split sum).
#ifndef LAMBENT_GLOSSY_GLOSSY_MATH_H
#define LAMBENT_GLOSSY_GLOSSY_MATH_H

#include "glossy/coat_path.h"
#include "raytracing/coat_share.h"
#include "raytracing/ray_cone.h"
#include "raytracing/ray_records.h"
#include "shared/cross_bilateral.h"
#include "shared/pixel_points.h"
#include "shared/random.h"

LAMBENT_BEGIN

/// Pixels to each side of one whose rays it takes, along a row; and rows of rays.
const int kReuse = 2;

// Coats up to this roughness have a ray at every pixel, whatever the rows between rays: their lobes
// are narrower than what the mirrored directions of neighbouring pixels differ by on a curved
// surface, so that neighbours' rays do not help.
const float kEveryPixelRoughness = 0.5f;

/// Surfaces that a ray meets in all, with those that it crosses.
const uint kMaxWays = 12u;

/// A ray goes on from coats that it meets up to this often; the field's light ends it ...
const uint kMaxCoatBounces = 4u;

/// ... where the light that is met next would count by at least this share in the pixel's ray.
const float kMinThroughput = 0.1f;

/// GGX width of coats that end a ray, at least: of roughness 0.5. The samples of their direct light
/// cannot find a lamp in narrower lobes.
const float kLeastEndAlpha = 0.25f;

/// Share of its own ray that a pixel has for each pixel around it: one over the rays in reach.
const float kOwnShare = 1.0f / 16.0f;

/// Most that a ray weighs where a pixel has none of its own. One that was drawn far off its own
/// lobe, and by chance falls into the pixel's, would outweigh all others.
const float kMaxReuseWeight = 4.0f;

/// So many rays that fit a lobe, or more, tell its albedo well enough to correct their mean by the
/// known one.
const float kRaysOfMean = 4.0f;

/// Neighbours of less weight count for nothing: one over it would be no number.
const float kLeastPixelWeight = 1e-12f;

/// Least of the sums of weights times the Fresnel term that light is divided by: that of
/// kLeastPixelWeight where a coat reflects one part in 1e8.
const float kLeastReflected = 1e-20f;

/// Neighbours count for nothing this far from a pixel's plane [pixels' widths at its depth]: the
/// plane of a sphere of few pixels falls off as much over the pixels in reach.
const float kPlaneTolerance = 4.0f;

// Keep the random numbers of rays and of lights at what they meet apart from those of other passes.
const uint kCoatSalt = 0x434F4154u;
const uint kCoatBounceSalt = 0x9E3779B9u;
const uint kThroughSalt = 0x5448524Fu;
const uint kClearcoatSalt = 0x434C5243u;

/// The seed of the random numbers of clearcoats' rays, by the frame's.
LAMBENT_FN uint clearcoat_seed(uint seed) {
  return seed ^ kClearcoatSalt;
}

/// The normal of a clearcoat on a surface with this shading normal.
LAMBENT_FN vec3 clearcoat_normal_ws(SurfaceLayers layers, vec3 normal_ws) {
  return to_world(make_frame(normal_ws), layers.clearcoat_normal);
}

/// The salt of a sample's random numbers at what rays meet on their way's bounce 1, 2, ...
LAMBENT_FN uint coat_salt(uint sample_index, uint bounce) {
  return (sample_index ^ kCoatSalt) + bounce * kCoatBounceSalt;
}

/// Whether a row has rays, of every `rows`-th one; the next sample has those of the next row.
LAMBENT_FN bool has_coat_rays(int row, uint sample_index, uint rows) {
  return (uint(row) + sample_index) % rows == 0u;
}

/// Whether a pixel has a ray.
LAMBENT_FN bool traces_coat(Reflectance surface, float coat_share, int row, uint sample_index,
                            uint rows) {
  if (coat_share <= 0.0f) return false;
  bool sharp = surface.alpha <= kEveryPixelRoughness * kEveryPixelRoughness;
  return sharp || has_coat_rays(row, sample_index, rows);
}

/// Where in the unit square a pixel draws its ray.
LAMBENT_FN vec2 coat_uniforms(uvec2 pixel, uint sample_index, uint rows, uint seed) {
  return pixel_point(pixel.x, pixel.y / rows, 0u, 1u, sample_index, seed ^ kCoatSalt);
}

/// A direction drawn of a coat's lobe.
struct CoatDraw {
  vec3 direction_ws;
  float pdf;    ///< [1/sr]; 0: it is below the surface, where no light comes from.
  vec3 weight;  ///< Share of the light from there that the coat reflects.
};

/// Walter et al. 2007, Eq. 33, of a half vector: exact for the narrowest lobes, too, where the
/// cosine alone tells nothing.
LAMBENT_FN float ggx_density(vec3 normal, vec3 h, float alpha) {
  float a2 = alpha * alpha;
  float cosine = dot(normal, h);
  vec3 sine = cross(normal, h);
  float d = cosine * cosine * a2 + dot(sine, sine);
  return a2 * kInvPi / (d * d);
}

LAMBENT_FN CoatDraw draw_coat_ray(Reflectance surface, Frame frame, vec3 to_viewer_ws, vec2 u) {
  CoatDraw drawn = {vec3(0.0f, 0.0f, 1.0f), 0.0f, vec3(0.0f)};
  vec3 v = to_local(frame, to_viewer_ws);
  if (v.z <= 0.0f) return drawn;
  vec3 h = sample_ggx_visible_normal(v, surface.alpha, u);
  vec3 l = reflect(-v, h);
  if (l.z <= 0.0f) return drawn;
  float lambda_v = ggx_lambda(v.z, surface.alpha);
  float lambda_l = ggx_lambda(l.z, surface.alpha);
  drawn.direction_ws = normalize(to_world(frame, l));
  drawn.pdf =
      ggx_density(vec3(0.0f, 0.0f, 1.0f), h, surface.alpha) / (4.0f * v.z * (1.0f + lambda_v));
  drawn.weight = fresnel(surface, dot(v, h)) * ((1.0f + lambda_v) / (1.0f + lambda_v + lambda_l));
  if (has_layers(surface.layers)) drawn.weight *= coat_share_under_layers(surface.layers, v, l);
  return drawn;
}

/// Where a coat's light comes from on average: the rougher, the nearer to the normal. Lagarde and
/// de Rousiers, "Moving Frostbite to PBR", SIGGRAPH courses 2014, sec. 4.9.3.
LAMBENT_FN vec3 coat_direction(vec3 normal_ws, vec3 to_viewer_ws, float alpha) {
  // Filtered textures bring roughness to a rounding above 1
  float sharpness = max(1.0f - alpha, 0.0f);
  float mirrored = sharpness * (sqrt(sharpness) + alpha);
  vec3 mirror = reflect(-to_viewer_ws, normal_ws);
  return normalize(normal_ws + (mirror - normal_ws) * mirrored);
}

/// Where the coat and the clearcoat of a surface have their light from on average, both together:
/// each counts by what it reflects. Of the coat only the share counts that has no rays.
LAMBENT_FN vec3 coats_direction(Reflectance surface, float coat_share, vec3 normal_ws,
                                vec3 to_viewer_ws) {
  vec3 of_coat = coat_direction(normal_ws, to_viewer_ws, surface.alpha);
  if (!has_clearcoat(surface.layers)) return of_coat;
  vec3 of_clearcoat = coat_direction(clearcoat_normal_ws(surface.layers, normal_ws), to_viewer_ws,
                                     surface.layers.clearcoat_alpha);
  vec3 reflected = specular_albedo(surface, dot(normal_ws, to_viewer_ws));
  float coat = surface.f90 > 0.0f ? (1.0f - coat_share) * luminance(reflected) : 0.0f;
  return normalize(of_coat * coat + of_clearcoat * clearcoat_albedo(surface.layers));
}

/// Radiance that a surface's base, under its coat, makes of indirect irradiance.
LAMBENT_FN vec3 reflected_indirect(Reflectance reflectance, float n_dot_v, vec3 irradiance) {
  return base_albedo(reflectance, n_dot_v) * irradiance * kInvPi;
}

/// Radiance that its coat makes of the irradiance on a surface that faces coat_direction(); 0
/// without a coat. Split sum, the field's cosine lobe in place of the coat's own.
LAMBENT_FN vec3 reflected_glossy(Reflectance reflectance, float n_dot_v, vec3 mirror_irradiance) {
  if (reflectance.f90 <= 0.0f) return vec3(0.0f);
  return specular_albedo(reflectance, n_dot_v) * mirror_irradiance * kInvPi;
}

/// A pixel's coat, where it is and to whom.
struct CoatLobe {
  vec3 position_ws;
  vec3 geometric_normal_ws;
  vec3 normal_ws;
  vec3 to_viewer_ws;
  float alpha;
};

/// What a lobe makes of light from a direction, and with which density it draws that [1/sr].
struct LobeValue {
  float value;  ///< BRDF times cosine over the Fresnel term [1/sr]; 0 below the surface.
  float pdf;
  float v_dot_h;
};

LAMBENT_FN LobeValue coat_lobe(CoatLobe of, vec3 direction_ws) {
  LobeValue none = {0.0f, 0.0f, 0.0f};
  float n_dot_v = dot(of.normal_ws, of.to_viewer_ws);
  float n_dot_l = dot(of.normal_ws, direction_ws);
  if (n_dot_v <= 0.0f || n_dot_l <= 0.0f) return none;
  vec3 h = normalize(of.to_viewer_ws + direction_ws);
  float density = ggx_density(of.normal_ws, h, of.alpha) / (4.0f * n_dot_v);
  float lambda_v = ggx_lambda(n_dot_v, of.alpha);
  LobeValue lobe = {density / (1.0f + lambda_v + ggx_lambda(n_dot_l, of.alpha)),
                    density / (1.0f + lambda_v), dot(of.to_viewer_ws, h)};
  return lobe;
}

/// The direction from `position_ws` to where a ray ends that starts at `origin_ws`.
LAMBENT_FN vec3 direction_to_end(vec3 position_ws, vec3 origin_ws, CoatRay ray) {
  if (floatBitsToUint(ray.distance) == kMissedDistanceBits) return ray.direction_ws;
  return normalize(ray.direction_ws * ray.distance + (origin_ws - position_ws));
}

LAMBENT_FN float inverse_plane_tolerance(CameraRecord camera, vec3 position_ws) {
  return 1.0f / (kPlaneTolerance * pixel_width(camera, position_ws));
}

/// A coat as it is seen through what lies on it, which takes the same share of the light of all of
/// its rays.
LAMBENT_FN Reflectance coat_under_layers(Reflectance surface, float n_dot_v) {
  if (!has_layers(surface.layers)) return surface;
  float share = mean_coat_share(surface.layers, max(n_dot_v, 0.0f), surface.alpha);
  Reflectance seen = surface;
  seen.f0 *= share;
  seen.f90 *= share;
  seen.layers = no_layers();
  return seen;
}

/// A pixel that reflects rays, its own and those around it.
struct CoatReceiver {
  CoatLobe lobe;
  Reflectance reflectance;  ///< As of coat_under_layers().
  float inverse_tolerance;  ///< One over kPlaneTolerance pixels at its depth [1/m].
  uint emitter_samples;     ///< Of its direct light; FrameSettings::emissive_samples.
  CoatRay own;              ///< Of density 0 where it has no ray.
  LobeValue at_own;         ///< Its lobe there.
  vec3 mirror_ws;           ///< Where its lobe is about densest, and how dense it is there [1/sr].
  float mirror_pdf;
};

/// Fills in what follows from a receiver's lobe and its own ray.
LAMBENT_FN void find_lobe(LAMBENT_INOUT(CoatReceiver) at) {
  LobeValue none = {0.0f, 0.0f, 0.0f};
  at.at_own = at.own.pdf > 0.0f ? coat_lobe(at.lobe, at.own.direction_ws) : none;
  at.mirror_ws = reflect(-at.lobe.to_viewer_ws, at.lobe.normal_ws);
  at.mirror_pdf = coat_lobe(at.lobe, at.mirror_ws).pdf;
}

/// Weighted sums over rays.
struct CoatSums {
  vec3 light;        ///< Reflected, but for what emissive surfaces send,
  vec3 emission;     ///< and that.
  float weight;      ///< Of the rays around, and
  float schlick;     ///< of these each times Schlick's (1 - v_dot_h)^5 of its ray,
  float own_weight;  ///< the weight of the pixel's own ray,
  float pixels;      ///< and that of the pixels that rays were taken of;
  float fitting;     ///< so many of these have the pixel's lobe.
};

/// Adds the light of a ray that a receiver's lobe gives this value, over the value and with this
/// weight. What emitters send counts by the weight that rays of the receiver's own have: its direct
/// light has left out as much.
LAMBENT_FN void add_light_of_ray(CoatReceiver at, LobeValue lobe, vec3 direction_ws, CoatRay ray,
                                 float weight, LAMBENT_INOUT(CoatSums) sums) {
  if (dot(at.lobe.geometric_normal_ws, direction_ws) <= 0.0f) return;
  vec3 reflected = weight * fresnel(at.reflectance, lobe.v_dot_h);
  sums.light += reflected * ray.radiance;
  sums.emission += reflected * (found_emitter_weight(lobe.pdf, at.emitter_samples) * ray.apart);
}

/// Adds what a receiver makes of a neighbour's ray, and of its own beside that one.
///
/// Where a ray ends is seen from both. Both rays could have ended there, drawn by the neighbour's
/// lobe or by the receiver's, whose one ray is shared out among all neighbours: the two have the
/// weights of the balance heuristic, which are bounded, for pairs of two densities (pairwise
/// multiple importance sampling: Bitterli, "Correlations and Reuse for Fast and Accurate Physically
/// Based Light Transport", 2022, ch. 9). Lobes that hardly overlap so leave each other alone.
LAMBENT_FN void add_coat_ray(CoatReceiver at, CoatLobe from, CoatRay ray, float weight,
                             LAMBENT_INOUT(CoatSums) sums) {
  float similar =
      relit_bilateral_weight(from.position_ws - at.lobe.position_ws, at.lobe.geometric_normal_ws,
                             from.geometric_normal_ws, at.inverse_tolerance);
  float pixel = weight * similar;
  if (pixel < kLeastPixelWeight) return;
  sums.pixels += pixel;
  if (at.mirror_pdf > 0.0f) {
    sums.fitting += pixel * min(coat_lobe(from, at.mirror_ws).pdf / at.mirror_pdf, 1.0f);
  }
  if (at.own.pdf > 0.0f) {
    LobeValue beside =
        coat_lobe(from, direction_to_end(from.position_ws, at.lobe.position_ws, at.own));
    sums.own_weight +=
        pixel * kOwnShare * at.at_own.value / (beside.pdf + kOwnShare * at.at_own.pdf);
  }
  if (ray.pdf < 0.0f) return;
  vec3 direction = direction_to_end(at.lobe.position_ws, from.position_ws, ray);
  LobeValue lobe = coat_lobe(at.lobe, direction);
  if (lobe.value <= 0.0f) return;
  float w = at.own.pdf != 0.0f ? lobe.value / (ray.pdf + kOwnShare * lobe.pdf)
                               : min(lobe.value / ray.pdf, kMaxReuseWeight);
  sums.weight += pixel * w;
  sums.schlick += pixel * w * schlick_power(lobe.v_dot_h);
  add_light_of_ray(at, lobe, direction, ray, pixel * w, sums);
}

/// Light that the receiver reflects by its own ray alone.
LAMBENT_FN vec3 reflected_own_ray(CoatReceiver at) {
  CoatSums alone = {vec3(0.0f), vec3(0.0f), 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  if (at.own.pdf > 0.0f) {
    float weight = at.at_own.value / at.at_own.pdf;
    add_light_of_ray(at, at.at_own, at.own.direction_ws, at.own, weight, alone);
  }
  return alone.light + alone.emission;
}

/// Light that the receiver reflects. Where many rays around fit its lobe, it is their mean over
/// what the lobe makes of them, times the known albedo of the lobe, and elsewhere what its own ray
/// brings: rays that hardly fit would count now and then and for much, which is grain in mirrors.
/// Both hold the Fresnel term: rays that meet the surface flatter have smaller weights and more of
/// it, so that the mean of few rays would be short of light without. How much of either counts is
/// decided by the lobes and not by the rays: where rays of large weights would decide for one and
/// those of small ones against it, energy would be lost. A receiver without a ray of its own always
/// takes the mean. What emitters send straight comes with weights of its own, by which a mean over
/// the others would be off. Negative where there is no ray.
LAMBENT_FN vec3 reflected_rays(CoatReceiver at, CoatSums sums) {
  if (sums.pixels <= 0.0f) return at.own.pdf == 0.0f ? vec3(-1.0f) : reflected_own_ray(at);
  if (sums.own_weight > 0.0f) {
    add_light_of_ray(at, at.at_own, at.own.direction_ws, at.own, sums.own_weight, sums);
    sums.weight += sums.own_weight;
    sums.schlick += sums.own_weight * schlick_power(at.at_own.v_dot_h);
  }
  float known = clamp((sums.fitting - 1.0f) / (kRaysOfMean - 1.0f), 0.0f, 1.0f);
  if (at.own.pdf == 0.0f) known = 1.0f;
  vec3 unknown = known < 1.0f ? reflected_own_ray(at) : vec3(0.0f);
  // One over the smallest of weights is no number
  if (sums.weight < kLeastPixelWeight) return at.own.pdf == 0.0f ? vec3(-1.0f) : unknown;
  if (known <= 0.0f) return unknown;
  vec3 reflected =
      at.reflectance.f0 * (sums.weight - sums.schlick) + vec3(at.reflectance.f90 * sums.schlick);
  vec3 albedo = specular_albedo(at.reflectance, dot(at.lobe.normal_ws, at.lobe.to_viewer_ws));
  vec3 scale = albedo / max(reflected, vec3(kLeastReflected));
  return mix(unknown, sums.light * scale + sums.emission / sums.pixels, known);
}

/// Light of reflected_rays() and 1; all 0 where there is no ray.
LAMBENT_FN vec4 light_by_rays(vec3 reflected) {
  return reflected.x < 0.0f ? vec4(0.0f) : vec4(reflected, 1.0f);
}

/// All that a pixel's coat reflects but for what lights sent it straight: by rays, if any reached
/// it, and by the field for the rest.
LAMBENT_FN vec3 coat_light(Reflectance reflectance, float n_dot_v, float gi_share, vec4 by_rays,
                           vec3 mirror_irradiance) {
  if (gi_share <= 0.0f) return vec3(0.0f);
  return vec3(by_rays.x, by_rays.y, by_rays.z) +
         (1.0f - by_rays.w) * reflected_glossy(reflectance, n_dot_v, mirror_irradiance);
}

/// The same of a clearcoat without rays.
LAMBENT_FN vec3 clearcoat_light(SurfaceLayers layers, float gi_share, vec3 mirror_irradiance) {
  if (gi_share <= 0.0f || !has_clearcoat(layers)) return vec3(0.0f);
  return clearcoat_albedo(layers) * mirror_irradiance * kInvPi;
}

/// All of that at a surface that a way met: of the coat, of whose light further rays bring
/// `coat_share`, and of the clearcoat, which has all its light from the field, along
/// coats_direction().
LAMBENT_FN vec3 coats_light(Reflectance reflectance, float n_dot_v, float gi_share,
                            float coat_share, vec3 mirror_irradiance) {
  return coat_light(reflectance, n_dot_v, gi_share, vec4(0.0f, 0.0f, 0.0f, coat_share),
                    mirror_irradiance) +
         clearcoat_light(reflectance.layers, gi_share, mirror_irradiance);
}

LAMBENT_END
#endif
