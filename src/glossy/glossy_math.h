// SPDX-License-Identifier: Apache-2.0
// Specular rays, and the light that a coat (a surface's GGX layer) reflects from the rays of its
// own pixel and of neighbouring ones.
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
#include "shared/demodulate.h"
#include "shared/pixel_points.h"
#include "shared/random.h"

LAMBENT_BEGIN

/// Reach of ray reuse: in pixels to each side along a row, and in rows that have rays up and down.
const int kReuse = 2;

// Coats up to this roughness have a ray at every pixel, whatever the rows between rays: their lobes
// are narrower than what the mirrored directions of neighbouring pixels differ by on a curved
// surface, so that neighbours' rays do not help.
const float kEveryPixelRoughness = 0.5f;

/// Most surfaces that a path hits before it ends at an opaque one, counting those that it passes
/// through. The field supplies what the coat of the last one reflects. Mirrors that face each other
/// show a blank wall there.
const uint kMaxPathVertices = 12u;

/// Most surfaces that a path hits. Beyond kMaxPathVertices it goes on in glass alone: light that is
/// reflected within a bottle's rim or a cut stone leaves it after many of them, and no other light
/// stands for it. With twice as many, a block of diamond takes 0.2 % of a picture, not 0.3 %.
const uint kMaxGlassVertices = 48u;

/// A path goes on from a coat only where the largest channel of its throughput would stay at least
/// this.
const float kMinThroughput = 0.1f;

/// Least GGX width of a coat that ends a path: that of roughness 0.5. The samples of its direct
/// light cannot find a lamp in narrower lobes.
const float kLeastEndAlpha = 0.25f;

/// Share of a pixel's own ray that is combined with each neighbour: one over the rays in reach.
const float kOwnShare = 1.0f / 16.0f;

/// Largest weight of a ray at a pixel that has none of its own. A ray that was drawn far off its
/// own lobe, and by chance falls into the pixel's, would outweigh all others.
const float kMaxReuseWeight = 4.0f;

/// From this many rays that fit a lobe, its reflected light is their mean times the lobe's known
/// albedo.
const float kRaysOfMean = 4.0f;

/// From this many rays of equal weight, half of those in reach, their own variance counts, not one
/// that is assumed.
const float kRaysOfVariance = 8.0f;

/// Neighbours of less weight are skipped: the reciprocal of their weight would be infinite.
const float kLeastPixelWeight = 1e-12f;

/// Lower bound of the divisor of light, a sum of weights times the Fresnel term: kLeastPixelWeight
/// where a coat reflects one part in 1e8.
const float kLeastReflected = 1e-20f;

/// Most that a single ray brings, as a share of what all others bring together of light that direct
/// light does not sample. What it brings above that is excess: so rare that the rays around cannot
/// tell where such light ends.
const float kMaxShareOfOthers = 0.5f;

/// Neighbours this far from a pixel's plane have no weight [pixel widths at its depth]: the surface
/// of a sphere that covers few pixels curves away as much from its tangent plane within the reach.
const float kPlaneTolerance = 4.0f;

/// Coats have further rays where at least this share of their light is that of their own ray.
const float kMinOwnShare = 0.25f;

// Salts that make the random numbers of these passes independent of those of other passes.
const uint kCoatSalt = 0x434F4154u;
const uint kCoatBounceSalt = 0x9E3779B9u;
const uint kFurtherRaySalt = 0x46525941u;
const uint kThroughSalt = 0x5448524Fu;
const uint kBehindSalt = 0x42484E44u;
const uint kClearcoatSalt = 0x434C5243u;

/// The seed of the random numbers of clearcoats' rays, given the frame's seed.
LAMBENT_FN uint clearcoat_seed(uint seed) {
  return seed ^ kClearcoatSalt;
}

/// The normal of a clearcoat on a surface with this shading normal.
LAMBENT_FN vec3 clearcoat_normal_ws(SurfaceLayers layers, vec3 normal_ws) {
  return to_world(make_frame(normal_ws), layers.clearcoat_normal);
}

/// The salt of a sample's random numbers at the hits of bounce 1, 2, ...
LAMBENT_FN uint coat_salt(uint sample_index, uint bounce) {
  return (sample_index ^ kCoatSalt) + bounce * kCoatBounceSalt;
}

/// Whether a row has rays: every `rows`-th does, and each sample moves on to the next rows.
LAMBENT_FN bool has_coat_rays(int row, uint sample_index, uint rows) {
  return (uint(row) + sample_index) % rows == 0u;
}

/// Whether a pixel traces a specular ray.
LAMBENT_FN bool traces_coat(Reflectance surface, float coat_share, int row, uint sample_index,
                            uint rows) {
  if (coat_share <= 0.0f) return false;
  bool sharp = surface.alpha <= kEveryPixelRoughness * kEveryPixelRoughness;
  return sharp || has_coat_rays(row, sample_index, rows);
}

/// The point in the unit square from which a pixel draws its ray.
LAMBENT_FN vec2 coat_uniforms(uvec2 pixel, uint sample_index, uint rows, uint seed) {
  return pixel_point(pixel.x, pixel.y / rows, 0u, 1u, sample_index, seed ^ kCoatSalt);
}

/// The point in the unit square from which a pixel draws ray number `ray`, 1 or more.
LAMBENT_FN vec2 further_coat_uniforms(uvec2 pixel, uint sample_index, uint ray, uint seed) {
  return coat_uniforms(pixel, sample_index, 1u, seed + ray * kFurtherRaySalt);
}

/// Whether a coat of this width has further rays: most of its light is that of its own ray, and not
/// a mirror's, which has little noise.
LAMBENT_FN bool needs_further_rays(OwnRayLight own, float alpha) {
  return own.share >= kMinOwnShare && alpha > kMirrorAlpha;
}

/// Light to add for the estimate `found` of one further ray, of which there are `rays` with the
/// first.
LAMBENT_FN vec3 further_light(OwnRayLight own, vec3 found, uint rays) {
  return (own.share / float(rays)) * (found - own.light);
}

/// For lanes, the same of all of them.
LAMBENT_FN bool all_zero(float x) {
  return x == 0.0f;
}

#define Real float
#define Real3 vec3
#define LAMBENT_REAL_FN LAMBENT_FN
#include "glossy/coat_sums.inl.h"
#undef Real
#undef Real3
#undef LAMBENT_REAL_FN

/// The lobe of a coat of this GGX width.
LAMBENT_FN CoatLobe make_coat_lobe(vec3 position_ws, vec3 geometric_normal_ws, vec3 normal_ws,
                                   vec3 to_viewer_ws, float alpha) {
  float n_dot_v = dot(normal_ws, to_viewer_ws);
  float lambda = ggx_lambda(n_dot_v, alpha);
  float pdf_scale = n_dot_v > 0.0f ? 1.0f / (4.0f * n_dot_v * (1.0f + lambda)) : 0.0f;
  CoatLobe lobe = {position_ws,   geometric_normal_ws, normal_ws, to_viewer_ws,
                   alpha * alpha, pdf_scale,           lambda};
  return lobe;
}

/// A direction drawn from a coat's lobe.
struct CoatDraw {
  vec3 direction_ws;
  float pdf;    ///< [1/sr]; 0: the direction is below the surface.
  vec3 weight;  ///< BRDF times cosine over pdf.
};

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
  drawn.pdf = ggx_density(vec3(0.0f, 0.0f, 1.0f), h, surface.alpha * surface.alpha) /
              (4.0f * v.z * (1.0f + lambda_v));
  drawn.weight = fresnel(surface, dot(v, h)) * ((1.0f + lambda_v) / (1.0f + lambda_v + lambda_l));
  if (has_layers(surface.layers)) drawn.weight *= coat_share_under_layers(surface.layers, v, l);
  return drawn;
}

/// The mean direction of the light that a coat reflects: the rougher, the nearer to the normal.
/// Lagarde and de Rousiers, "Moving Frostbite to PBR", SIGGRAPH courses 2014, sec. 4.9.3.
LAMBENT_FN vec3 coat_direction(vec3 normal_ws, vec3 to_viewer_ws, float alpha) {
  // Filtered textures can exceed a roughness of 1 by rounding
  float sharpness = max(1.0f - alpha, 0.0f);
  float mirrored = sharpness * (sqrt(sharpness) + alpha);
  vec3 mirror = reflect(-to_viewer_ws, normal_ws);
  return normalize(normal_ws + (mirror - normal_ws) * mirrored);
}

/// The mean direction of the light that a surface's coat and clearcoat reflect, each weighted by
/// its albedo. The shares of their light that rays supply are left out.
LAMBENT_FN vec3 coats_direction(Reflectance surface, CoatShares shares, vec3 normal_ws,
                                vec3 to_viewer_ws) {
  vec3 of_coat = coat_direction(normal_ws, to_viewer_ws, surface.alpha);
  if (!has_clearcoat(surface.layers) || shares.clearcoat >= 1.0f) return of_coat;
  vec3 of_clearcoat = coat_direction(clearcoat_normal_ws(surface.layers, normal_ws), to_viewer_ws,
                                     surface.layers.clearcoat_alpha);
  vec3 reflected = specular_albedo(surface, dot(normal_ws, to_viewer_ws));
  float coat = surface.f90 > 0.0f ? (1.0f - shares.coat) * luminance(reflected) : 0.0f;
  float clearcoat = (1.0f - shares.clearcoat) * clearcoat_albedo(surface.layers);
  return normalize(of_coat * coat + of_clearcoat * clearcoat);
}

/// Radiance that a surface's base, under its coat, reflects of indirect irradiance.
LAMBENT_FN vec3 reflected_indirect(Reflectance reflectance, float n_dot_v, vec3 irradiance) {
  return base_albedo(reflectance, n_dot_v) * irradiance * kInvPi;
}

/// Radiance that a surface's coat reflects, given the irradiance on a surface that faces
/// coat_direction(); 0 without a coat. Split sum, with the field's cosine lobe in place of the
/// coat's own.
LAMBENT_FN vec3 reflected_glossy(Reflectance reflectance, float n_dot_v, vec3 mirror_irradiance) {
  if (reflectance.f90 <= 0.0f) return vec3(0.0f);
  return specular_albedo(reflectance, n_dot_v) * mirror_irradiance * kInvPi;
}

LAMBENT_FN float inverse_plane_tolerance(CameraRecord camera, vec3 position_ws) {
  return 1.0f / (kPlaneTolerance * pixel_width(camera, position_ws));
}

/// A coat as seen through the layers above it, which transmit the same share of the light of all of
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

/// Sets the fields that follow from a receiver's lobe and its own ray.
LAMBENT_FN void find_lobe(LAMBENT_INOUT(CoatReceiver) at) {
  LobeValue none = {0.0f, 0.0f, 0.0f};
  at.at_own = at.own.pdf > 0.0f ? coat_lobe(at.lobe, at.own.direction_ws) : none;
  at.mirror_ws = reflect(-at.lobe.to_viewer_ws, at.lobe.normal_ws);
  float mirror_pdf = coat_lobe(at.lobe, at.mirror_ws).pdf;
  at.inverse_mirror_pdf = mirror_pdf > 0.0f ? 1.0f / mirror_pdf : 0.0f;
}

/// Radiance that the receiver reflects, estimated from its own ray alone.
LAMBENT_FN vec3 reflected_own_ray(CoatReceiver at) {
  CoatSums alone = no_coat_sums();
  if (at.own.pdf > 0.0f) {
    float weight = at.at_own.value / at.at_own.pdf;
    add_light_of_ray(at, at.at_own, at.own.direction_ws, at.own, weight, alone);
  }
  return alone.light + alone.emission;
}

/// The record of the coat that a receiver's mirror shows, with its light and its mirror image, and
/// the mirror's own share. `share`: that of the mirror's light which comes from rays.
LAMBENT_FN MirroredCoat mirrored_light(CoatReceiver at, float share, MirroredCoat coat) {
  at.own.apart = vec3(0.0f);
  at.own.radiance = vec3(1.0f);
  coat.mirror_share = share * reflected_own_ray(at);
  if (coat.alpha <= 0.0f) return coat;
  at.own.radiance = at.own.mirrored;
  coat.light = share * reflected_own_ray(at);
  vec3 tint = specular_albedo(at.reflectance, dot(at.lobe.normal_ws, at.lobe.to_viewer_ws));
  coat.albedo *= share * max(tint, vec3(kLeastFilteredAlbedo));
  vec3 across = at.lobe.normal_ws;
  coat.position_ws -= 2.0f * dot(coat.position_ws - at.lobe.position_ws, across) * across;
  coat.normal_ws -= 2.0f * dot(coat.normal_ws, across) * across;
  return coat;
}

/// Radiance that a receiver reflects of the rays around it.
struct ReflectedRays {
  vec3 light;   ///< All of it but CoatRay::mirrored; negative where there is no ray.
  vec3 excess;  ///< The part of it that is excess, see kMaxShareOfOthers.
  vec3 own;     ///< The estimate of the receiver's own ray alone; valid where own_share is not 0.
  float own_share;  ///< Share of `own` in the light.
  /// Variance of the luminance that one ray brings, as a share of the squared mean; 0 where the
  /// receiver's own ray is all that it reflects.
  float ray_variance;
};

/// ReflectedRays::ray_variance, from the sums over a receiver's rays.
LAMBENT_FN float ray_variance_of(CoatSums sums) {
  float total = luminance(sums.light + sums.emission);
  if (total <= 0.0f) return 0.0f;
  float variance = max(sums.squares * sums.weight / (total * total) - 1.0f, 0.0f);
  // The variance of few rays is not known. It is assumed to be at least their squared mean, as
  // where every second ray finds light
  float rays = sums.weight * sums.weight / max(sums.squared_weights, kLeastPixelWeight);
  return max(variance, clamp((kRaysOfVariance - rays) / (kRaysOfVariance - 1.0f), 0.0f, 1.0f));
}

/// The part of the brightest ray's light that is excess. A ray may always bring its share of the
/// weights: the rays of pixels whose lobes fit no neighbour's have most of them.
LAMBENT_FN vec3 excess_of(CoatSums sums) {
  float brought = luminance(sums.brightest);
  float others = max(luminance(sums.light) - brought, 0.0f);
  float weight_of_others = sums.weight - sums.brightest_weight;
  if (weight_of_others <= 0.0f) return vec3(0.0f);
  float most = max(kMaxShareOfOthers, sums.brightest_weight / weight_of_others) * others;
  return brought > most ? sums.brightest * (1.0f - most / brought) : vec3(0.0f);
}

/// Computes the radiance that the receiver reflects.
///
/// Where many rays around fit its lobe, it is their mean divided by the mean of the lobe's weights,
/// times the known albedo of the lobe. Elsewhere it is the estimate of its own ray: rays that
/// hardly fit count rarely and strongly, which is grain in mirrors. The divisor includes the
/// Fresnel term: rays at grazing incidence have smaller weights and a larger Fresnel term, so that
/// without it the mean of few rays would be too dark. The blend of the two depends on the lobes and
/// not on the rays: if rays of large weights led to the one and rays of small weights to the other,
/// energy would be lost. A receiver without a ray of its own always takes the mean. Emission has
/// weights of multiple importance sampling already, so that it is divided by the weight of the
/// pixels alone.
LAMBENT_FN ReflectedRays reflected_rays(CoatReceiver at, CoatSums sums) {
  bool has_own = at.own.pdf != 0.0f;
  ReflectedRays rays = {vec3(-1.0f), vec3(0.0f), vec3(0.0f), has_own ? 1.0f : 0.0f, 0.0f};
  if (sums.pixels <= 0.0f) {
    if (has_own) rays.light = rays.own = reflected_own_ray(at);
    return rays;
  }
  if (sums.own_weight > 0.0f) {
    add_light_of_ray(at, at.at_own, at.own.direction_ws, at.own, sums.own_weight, sums);
    sums.weight += sums.own_weight;
    sums.schlick += sums.own_weight * schlick_power(at.at_own.v_dot_h);
  }
  float known = clamp((sums.fitting - 1.0f) / (kRaysOfMean - 1.0f), 0.0f, 1.0f);
  if (!has_own) known = 1.0f;
  vec3 unknown = known < 1.0f ? reflected_own_ray(at) : vec3(0.0f);
  if (has_own) rays.light = rays.own = unknown;
  // The reciprocal of the smallest weights is infinite
  if (sums.weight < kLeastPixelWeight || known <= 0.0f) return rays;
  vec3 reflected =
      at.reflectance.f0 * (sums.weight - sums.schlick) + vec3(at.reflectance.f90 * sums.schlick);
  vec3 albedo = specular_albedo(at.reflectance, dot(at.lobe.normal_ws, at.lobe.to_viewer_ws));
  vec3 scale = albedo / max(reflected, vec3(kLeastReflected));
  rays.own_share = 1.0f - known;
  rays.light = mix(unknown, sums.light * scale + sums.emission / sums.pixels, known);
  rays.excess = known * scale * excess_of(sums);
  rays.ray_variance = known * ray_variance_of(sums);
  return rays;
}

/// The light of reflected_rays() and 1; all 0 where there is no ray.
LAMBENT_FN vec4 light_by_rays(vec3 reflected) {
  return reflected.x < 0.0f ? vec4(0.0f) : vec4(reflected, 1.0f);
}

/// The light that a pixel's coat reflects, without the lights' direct light: from rays, if it has
/// any, and from the field for the rest.
LAMBENT_FN vec3 coat_light(Reflectance reflectance, float n_dot_v, float gi_share, vec4 by_rays,
                           vec3 mirror_irradiance) {
  if (gi_share <= 0.0f) return vec3(0.0f);
  return vec3(by_rays.x, by_rays.y, by_rays.z) +
         (1.0f - by_rays.w) * reflected_glossy(reflectance, n_dot_v, mirror_irradiance);
}

/// The light that a clearcoat without rays reflects, from the field alone.
LAMBENT_FN vec3 clearcoat_light(SurfaceLayers layers, float gi_share, vec3 mirror_irradiance) {
  if (gi_share <= 0.0f || !has_clearcoat(layers)) return vec3(0.0f);
  return clearcoat_albedo(layers) * mirror_irradiance * kInvPi;
}

/// The light that coat and clearcoat reflect at a path's hit, without the shares that further rays
/// supply. It comes from the field, looked up along coats_direction().
LAMBENT_FN vec3 coats_light(Reflectance reflectance, float n_dot_v, float gi_share,
                            CoatShares shares, vec3 mirror_irradiance) {
  return coat_light(reflectance, n_dot_v, gi_share, vec4(0.0f, 0.0f, 0.0f, shares.coat),
                    mirror_irradiance) +
         (1.0f - shares.clearcoat) *
             clearcoat_light(reflectance.layers, gi_share, mirror_irradiance);
}

LAMBENT_END
#endif
