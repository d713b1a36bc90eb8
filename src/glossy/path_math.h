// SPDX-License-Identifier: Apache-2.0
// How paths continue from the surfaces that they hit.
#ifndef LAMBENT_GLOSSY_PATH_MATH_H
#define LAMBENT_GLOSSY_PATH_MATH_H

#include "glossy/glass_choice.h"
#include "glossy/glossy_math.h"
#include "raytracing/transmission_math.h"
#include "scene/sky/bright_sky.h"
#include "shared/demodulate.h"

LAMBENT_BEGIN

/// Shares of the light of a coat and a clearcoat that further rays supply where a path hit them.
///
/// What glass shows is seen as if nothing were before it: there rays look for the lamps and the
/// scenery that coats mirror, however little they reflect, and for those that clearcoats do. So
/// they do for glass, wherever a path hits it: the path splits, or goes one way at random, which
/// takes no ray more.
LAMBENT_FN CoatShares further_coat_shares(Transmission through, Reflectance surface, float n_dot_v,
                                          CoatPath path, uint bounce) {
  CoatShares shares = {0.0f, 0.0f};
  if (bounce >= (is_transmissive(through) ? kMaxGlassVertices : kMaxPathVertices)) return shares;
  bool seen_through = path.stage == kStageThroughGlass || path.stage == kStageLongWay;
  if (seen_through || is_transmissive(through)) {
    shares.coat = traced_coat_share(surface);
    if (!is_transmissive(through) && has_clearcoat(surface.layers)) {
      shares.clearcoat = traced_coat_share(clearcoat_alone(surface.layers));
    }
    return shares;
  }
  float share = traced_coat_share(surface);
  if (share <= 0.0f) return shares;
  vec3 carried = path.throughput * specular_albedo(surface, n_dot_v) * share;
  if (max(carried.x, max(carried.y, carried.z)) >= kMinThroughput) shares.coat = share;
  return shares;
}

/// Prepares the coats of a surface that a path hit, and returns the shares of their light that
/// further rays supply. Widens their lobes to the widest on the path, which blurs them as much, and
/// to at least kLeastEndAlpha where no further ray looks for the lamps that they mirror. Narrower
/// lobes would be hit by hardly any ray, and would then be a bright speck.
/// Kaplanyan and Dachsbacher, "Path Space Regularization for Holistic and Robust Light Transport",
/// Eurographics 2013.
LAMBENT_FN CoatShares regularize_lobes(float n_dot_v, float gi_share, uint bounce,
                                       Transmission through, LAMBENT_INOUT(Reflectance) coat,
                                       CoatPath path) {
  coat.alpha = max(coat.alpha, path.alpha);
  coat.layers.clearcoat_alpha = max(coat.layers.clearcoat_alpha, path.alpha);
  CoatShares shares = {0.0f, 0.0f};
  if (gi_share > 0.0f) shares = further_coat_shares(through, coat, n_dot_v, path, bounce);
  if (shares.coat <= 0.0f) coat.alpha = max(coat.alpha, kLeastEndAlpha);
  if (shares.clearcoat <= 0.0f) {
    coat.layers.clearcoat_alpha = max(coat.layers.clearcoat_alpha, kLeastEndAlpha);
  }
  return shares;
}

/// CoatRay::distance after a path's hit, which lies `further` from the one before [m]: the distance
/// to the ray's first hit, or, of a path through surfaces, to the first opaque one.
LAMBENT_FN float distance_met(CoatPath path, uint bounce, float so_far, float further) {
  if (bounce == 1u) return further;
  if (path.fork == kForkBranch) return so_far;
  return path.stage == kStageThroughGlass ? so_far + further : so_far;
}

/// The distance from an opaque surface behind glass to what its coat reflects [m], which may lie
/// behind further glass. `so_far` is below 0 until the coat's ray has hit something; `further` is
/// added on each hit of such a path.
LAMBENT_FN float farther_seen(CoatPath path, float so_far, float further) {
  bool adds = path.stage == kStageCoatBehindGlass && path.fork != kForkBranch;
  return adds ? max(so_far, 0.0f) + further : so_far;
}

/// Whether a path has reached the first opaque surface behind glass, whose light is stored apart to
/// be filtered.
LAMBENT_FN bool reaches_opaque_surface(CoatPath path, Transmission through) {
  bool is_first = path.stage == kStageOther || path.stage == kStageThroughGlass;
  return is_first && path.fork != kForkBranch && !is_transmissive(through);
}

// Passed in place of the random number that decides on inner reflection, which is below its share.
const float kAlwaysReflected = -1.0f, kNeverReflected = 1.0f;

/// Brings the stage of a path that has met many surfaces up to date, before the light of its hit on
/// bounce `bounce` is added. Its surfaces sample no lights from there on.
LAMBENT_FN void note_long_way(uint bounce, LAMBENT_INOUT(CoatPath) path) {
  if (path.stage == kStageThroughGlass && bounce > kMaxPathVertices) path.stage = kStageLongWay;
}

/// Adds light at a path's hit, without its emission, to the light of its pixel's ray.
LAMBENT_FN void add_radiance(CoatPath path, vec3 light, LAMBENT_INOUT(CoatRay) ray) {
  if (path.stage == kStageBeyondMirroredCoat || path.stage == kStageLongWay) {
    ray.mirrored += path.throughput * light;
  } else if (path.stage >= kStageCoatBehindGlass) {
    ray.apart += path.throughput * light;
  } else {
    ray.radiance += path.throughput * light;
  }
}

/// Adds light that samples of lights find, too, at a path's hit, to the light of its pixel's ray.
/// `emitted`: see CoatRay::apart_luminance. Multiple importance sampling combines the two
/// estimates. Light that pixels' coats find is stored apart: neighbouring pixels, which reflect it
/// as well, weigh it by their own lobes.
LAMBENT_FN void meet_light(CoatPath path, vec3 radiance, float emitted,
                           LAMBENT_INOUT(CoatRay) ray) {
  if (radiance == vec3(0.0f)) return;
  // A ray through glowing glass can meet two lights; the first decides
  bool is_first = ray.apart == vec3(0.0f);
  bool is_own = path.stage == kStageOwnCoat || path.stage == kStageOwnMirror;
  if (is_own && (is_first || ray.apart_luminance == emitted)) {
    ray.apart += path.throughput * radiance;
    ray.apart_luminance = emitted;
  } else {
    float density = sampled_density(emitted, path.density_scale);
    add_radiance(path, found_light_weight(path.pdf, density) * radiance, ray);
  }
}

/// The albedo that a coat's light from rays is divided by before it is filtered, where rays supply
/// the share `coat_share` of its light.
LAMBENT_FN vec3 filtered_coat_albedo(Reflectance surface, float n_dot_v, float coat_share) {
  vec3 albedo = specular_albedo(coat_under_layers(surface, n_dot_v), n_dot_v);
  return coat_share * max(albedo, vec3(kLeastFilteredAlbedo));
}

/// The stage in which a pixel's coat of this width starts its path. `keeps_mirrored`: what coats in
/// mirrors reflect is filtered.
LAMBENT_FN uint first_stage(float alpha, bool keeps_mirrored) {
  return keeps_mirrored && alpha <= kMirrorAlpha ? kStageOwnMirror : kStageOwnCoat;
}

/// MirroredCoat::seen_distance after a hit that lies `further` from the one before [m].
LAMBENT_FN float seen_beyond(CoatPath path, float so_far, float further) {
  return path.stage == kStageBeyondMirroredCoat && so_far < 0.0f ? further : so_far;
}

/// Describes the coat that a path's hit shows in the pixel's mirror, if the path goes on from it
/// with `shares`.
LAMBENT_FN void meet_mirrored_coat(Transmission through, Reflectance surface, CoatShares shares,
                                   vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                                   LAMBENT_INOUT(CoatPath) path, LAMBENT_INOUT(MirroredCoat) coat) {
  if (path.stage != kStageOwnMirror || is_transmissive(through)) return;
  if (surface.alpha <= kMirrorAlpha || shares.coat <= 0.0f) return;
  coat.position_ws = position_ws;
  coat.normal_ws = normal_ws;
  coat.alpha = surface.alpha;
  coat.albedo = filtered_coat_albedo(surface, dot(normal_ws, to_viewer_ws), 1.0f);
  path.stage = kStageAtMirroredCoat;
}

/// Whether a path's hit is the opaque surface that the pixel's mirror shows, for ShownBase.
/// Call it before the path goes on.
LAMBENT_FN bool is_in_own_mirror(CoatPath path, Transmission through, Reflectance surface) {
  bool own = path.stage == kStageOwnMirror || path.stage == kStageAtMirroredCoat ||
             path.stage == kStageFurtherMirror;
  bool sharp = path.alpha <= kSharpMirrorAlpha;
  return own && sharp && !is_transmissive(through) && !has_no_base(surface);
}

/// Adds direct light at a path's hit. What a coat in the pixel's mirror reflects of it is stored
/// with the rest of its light.
LAMBENT_FN void add_direct_light(CoatPath path, vec3 diffuse, vec3 specular,
                                 LAMBENT_INOUT(CoatRay) ray) {
  if (path.stage == kStageAtMirroredCoat) {
    ray.mirrored += path.throughput * specular;
    specular = vec3(0.0f);
  }
  add_radiance(path, diffuse + specular, ray);
}

/// Adds the emission at a path's hit to the light of its pixel's ray. `emitted`:
/// emission_luminance() of what it hit.
LAMBENT_FN void meet_emitter(CoatPath path, vec3 emission, float emitted,
                             LAMBENT_INOUT(CoatRay) ray) {
  meet_light(path, emission, emitted, ray);
}

/// Adds the sky that a path meets to the light of its pixel's ray. Coats sample its bright part.
LAMBENT_FN void meet_sky(CoatPath path, SkySeen sky, LAMBENT_INOUT(CoatRay) ray) {
  add_radiance(path, sky.dim, ray);
  meet_light(path, sky.bright, -float(kSkyCandidates) * sky.density, ray);
}

/// The tint that transmitted light is divided by before it is filtered.
LAMBENT_FN vec3 filtered_tint(Transmission through) {
  return max(through.tint, vec3(kLeastFilteredAlbedo));
}

/// The lobe through which a rough surface shows what is behind it: that of a coat which faces away
/// from the camera. Volumes spread light less than that, 0.6 times as wide where their ior is 1.5,
/// but are filtered over this lobe all the same, see docs/math.md.
struct SeenLobe {
  vec3 to_viewer_ws;  ///< The viewer whose lobe such a coat would have; unit.
  float alpha;        ///< GGX width of its lobe; 0: what is behind is seen sharp.
};

LAMBENT_FN SeenLobe seen_lobe(Transmission through, vec3 normal_ws, vec3 to_viewer_ws) {
  SeenLobe lobe = {to_viewer_ws, 0.0f};
  if (through.alpha <= kStraightAlpha) return lobe;
  vec3 onwards = -to_viewer_ws;
  if (through.kind != kCrossesPane) onwards = refract(-to_viewer_ws, normal_ws, through.eta);
  if (onwards == vec3(0.0f)) return lobe;  // total internal reflection
  lobe.to_viewer_ws = reflect(-onwards, normal_ws);
  lobe.alpha = through.alpha;
  return lobe;
}

/// The ray on which a path continues.
struct NextRay {
  vec3 direction_ws;
  float side;  ///< 1: it starts on the side of the surface that the path came from; -1: behind it.
};

/// Probability with which a path goes on from the clearcoat of a surface rather than from its coat:
/// the clearcoat's part of what further rays are to find.
LAMBENT_FN float clearcoat_chance(Reflectance surface, CoatShares shares, float n_dot_v) {
  if (shares.clearcoat <= 0.0f) return 0.0f;
  if (shares.coat <= 0.0f) return 1.0f;
  float clearcoat = shares.clearcoat * clearcoat_albedo(surface.layers);
  float coat = shares.coat * luminance(specular_albedo(surface, n_dot_v));
  return clearcoat > 0.0f ? clearcoat / (clearcoat + coat) : 0.0f;
}

/// Continues a path by reflection from a coat or, at random, from the clearcoat on it, where
/// further rays supply the shares `shares` of their light; `density_scale`: emitter_density_scale()
/// at the surface. Sets the path's pdf, which is that of the lobe that was chosen, to 0 where it
/// ends: samples of lights are weighed against each lobe by itself.
LAMBENT_FN NextRay extend_by_reflection(Reflectance coat, CoatShares shares, vec3 normal_ws,
                                        vec3 geometric_normal_ws, vec3 to_viewer_ws,
                                        float density_scale, vec2 u, LAMBENT_INOUT(CoatPath) path) {
  NextRay next = {normal_ws, 1.0f};
  path.pdf = 0.0f;
  float chance = clearcoat_chance(coat, shares, dot(normal_ws, to_viewer_ws));
  bool from_clearcoat = u.x < chance;
  vec3 lobe_normal_ws = normal_ws;
  float share = shares.coat;
  bool has_base = !has_no_base(coat);
  if (from_clearcoat) {
    u.x /= chance;
    share = shares.clearcoat / chance;
    lobe_normal_ws = clearcoat_normal_ws(coat.layers, normal_ws);
    coat = clearcoat_alone(coat.layers);
  } else if (chance > 0.0f) {
    u.x = min((u.x - chance) / (1.0f - chance), kLargestUniform);
    share /= 1.0f - chance;
  }
  if (share <= 0.0f) return next;
  CoatDraw drawn = draw_coat_ray(coat, make_frame(lobe_normal_ws), to_viewer_ws, u);
  if (drawn.pdf <= 0.0f || dot(geometric_normal_ws, drawn.direction_ws) <= 0.0f) return next;
  path.throughput *= share * drawn.weight;
  path.pdf = drawn.pdf;
  path.density_scale = density_scale;
  path.alpha = coat.alpha;
  // Only the coat's light is filtered over the coat's lobe
  bool filtered = path.stage == kStageBehindGlass && !from_clearcoat;
  bool in_mirror = path.stage == kStageOwnMirror || path.stage == kStageFurtherMirror;
  if (path.stage == kStageAtMirroredCoat && !from_clearcoat) {
    path.stage = kStageBeyondMirroredCoat;
  } else if (in_mirror && coat.alpha <= kSharpMirrorAlpha && !has_base) {
    path.stage = kStageFurtherMirror;
  } else if (path.stage == kStageBehindGlass || path.stage == kStageBeyondClearcoat) {
    path.stage = filtered ? kStageCoatBehindGlass : kStageBeyondClearcoat;
  } else if (path.stage < kStageBehindGlass) {
    path.stage = kStageOther;
  }
  next.direction_ws = drawn.direction_ws;
  return next;
}

/// Whether lights behind a surface that a path hit are sampled.
LAMBENT_FN bool samples_lights_behind(CoatPath path, Transmission through) {
  return path.stage == kStageThroughGlass && samples_lights_behind(through);
}

/// Continues a path through a surface, or from the inside of its volume, where it may be reflected.
/// `density_scale`: emitter_density_scale() at the surface.
LAMBENT_FN NextRay extend_through_glass(Transmission through, Reflectance coat, vec3 normal_ws,
                                        vec3 to_viewer_ws, float density_scale, vec3 u,
                                        LAMBENT_INOUT(CoatPath) path) {
  ThroughDraw drawn = draw_through(through, coat, normal_ws, to_viewer_ws, u);
  path.throughput *= drawn.weight;
  path.alpha = max(path.alpha, through.alpha);
  if (path.stage == kStageThroughGlass && !goes_straight(through)) {
    path.pdf = drawn.pdf > 0.0f ? drawn.pdf : kNoLightSampling;
    path.density_scale = drawn.pdf > 0.0f ? density_scale : 0.0f;
  } else if (path.stage == kStageLongWay) {
    path.pdf = kNoLightSampling;
    path.density_scale = 0.0f;
  }
  if (drawn.weight == vec3(0.0f)) path.pdf = 0.0f;
  NextRay next = {drawn.direction_ws, drawn.crosses != 0u ? -1.0f : 1.0f};
  return next;
}

/// Probability with which a path goes on through the surface that it hit on bounce `bounce`. From
/// the inside of a volume it is 1: extend_through_glass() decides on inner reflection.
LAMBENT_FN float crossing_chance(Transmission through, Reflectance coat, float coat_share,
                                 float n_dot_v, uint bounce) {
  if (bounce >= kMaxGlassVertices || !is_transmissive(through)) return 0.0f;
  return crossing_probability(passing_share(through, coat, n_dot_v),
                              coat_share * specular_albedo(coat, n_dot_v));
}

/// Whether a path splits into two branches at the surface that it hit on bounce `bounce`.
LAMBENT_FN bool forks(CoatPath path, Transmission through, Reflectance coat, float coat_share,
                      float n_dot_v, uint bounce) {
  if (path.fork != kForks || through.alpha > kStraightAlpha) return false;
  if (path.stage == kStageLongWay) return false;
  float crossing = crossing_chance(through, coat, coat_share, n_dot_v, bounce);
  if (through.kind == kLeavesVolume) crossing *= 1.0f - inner_reflection(n_dot_v, through.eta);
  return crossing > 0.0f && crossing < 1.0f;
}

/// Goes on with a part of the light where a path splits: within a volume, the main way goes on with
/// the greater one of what the surface lets pass and what it reflects, from outside with what
/// passes. The branch goes the other way.
LAMBENT_FN NextRay extend_split(bool is_main, Transmission through, Reflectance coat,
                                CoatShares shares, vec3 normal_ws, vec3 geometric_normal_ws,
                                vec3 to_viewer_ws, float density_scale, vec2 u,
                                LAMBENT_INOUT(CoatPath) path) {
  bool crosses = is_main;
  if (through.kind == kLeavesVolume) {
    float reflected = inner_reflection(dot(normal_ws, to_viewer_ws), through.eta);
    crosses = is_main == (reflected <= 1.0f - reflected);
    path.throughput *= crosses ? 1.0f - reflected : reflected;
  } else if (!is_main) {
    return extend_by_reflection(coat, shares, normal_ws, geometric_normal_ws, to_viewer_ws,
                                density_scale, u, path);
  }
  return extend_through_glass(through, coat, normal_ws, to_viewer_ws, density_scale,
                              vec3(u, crosses ? kNeverReflected : kAlwaysReflected), path);
}

/// Continues a path from its hit on bounce `bounce`: through the surface, or by reflection from its
/// coat. Where both are possible, `choice` decides, unless the path has split there.
/// `density_scale`: emitter_density_scale() at the surface; so it is below.
LAMBENT_FN NextRay go_on(Transmission through, Reflectance coat, CoatShares shares, vec3 normal_ws,
                         vec3 geometric_normal_ws, vec3 to_viewer_ws, float density_scale,
                         uint bounce, GlassChoice choice, RandomStream random,
                         LAMBENT_INOUT(CoatPath) path) {
  vec2 u = next_uniform2(random);
  float n_dot_v = dot(normal_ws, to_viewer_ws);
  if (path.fork == kHasForked) {
    path.fork = kForks;
    return extend_split(true, through, coat, shares, normal_ws, geometric_normal_ws, to_viewer_ws,
                        density_scale, u, path);
  }
  bool clear = path.stage == kStageThroughGlass && through.alpha <= kStraightAlpha;
  float least = clear ? choice.least_chance : 0.0f;
  float crossing = crossing_chance(through, coat, shares.coat, n_dot_v, bounce);
  if (crossing > 0.0f && least > 0.0f && through.kind == kLeavesVolume) {
    float crosses = 1.0f - inner_reflection(n_dot_v, through.eta);
    float chance = moderate_chance(crosses, least);
    bool is_crossed = choice.number < chance;
    path.throughput *= is_crossed ? crosses / chance : (1.0f - crosses) / (1.0f - chance);
    return extend_through_glass(through, coat, normal_ws, to_viewer_ws, density_scale,
                                vec3(u, is_crossed ? kNeverReflected : kAlwaysReflected), path);
  }
  crossing = moderate_chance(crossing, least);
  // Elsewhere each ray of a pixel chooses by a number of its own, if there is a choice
  float number = choice.number;
  if (least <= 0.0f && crossing > 0.0f && crossing < 1.0f) number = next_uniform(random);
  if (crossing > 0.0f && number < crossing) {
    path.throughput /= crossing;
    return extend_through_glass(through, coat, normal_ws, to_viewer_ws, density_scale,
                                vec3(u, next_uniform(random)), path);
  }
  if (crossing > 0.0f) path.throughput /= 1.0f - crossing;
  // The coat samples lights, which glass that the path crosses from here on must not forget
  if (path.stage == kStageLongWay && !is_transmissive(through)) path.stage = kStageOther;
  return extend_by_reflection(coat, shares, normal_ws, geometric_normal_ws, to_viewer_ws,
                              density_scale, u, path);
}

/// Splits a path at a step, see pack_path_step(): returns the ray of its branch.
///
/// Of a pixel's few samples each keeps one branch in place of many, which is a dot: what comes to
/// it within a volume is filtered as light of long ways is. Of more samples, neighbours' light
/// would only blur it.
LAMBENT_FN NextRay split(Transmission through, Reflectance coat, CoatShares shares, vec3 normal_ws,
                         vec3 geometric_normal_ws, vec3 to_viewer_ws, float density_scale,
                         uint path_step, RandomStream random, LAMBENT_INOUT(CoatPath) path,
                         LAMBENT_INOUT(CoatPath) branch) {
  branch = path;
  branch.fork = kForkBranch;
  path.fork = kHasForked;
  NextRay next = extend_split(false, through, coat, shares, normal_ws, geometric_normal_ws,
                              to_viewer_ws, density_scale, next_uniform2(random), branch);
  if (branch.stage == kStageThroughGlass && !is_stratified(path_step)) branch.stage = kStageLongWay;
  return next;
}

LAMBENT_END
#endif
