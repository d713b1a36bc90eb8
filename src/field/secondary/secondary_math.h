// SPDX-License-Identifier: Apache-2.0
// Rays that gather light: of pixels, and of points at which corrections are learned. Secondary
// gathers at their hits, and what they contribute.
#ifndef LAMBENT_FIELD_SECONDARY_SECONDARY_MATH_H
#define LAMBENT_FIELD_SECONDARY_SECONDARY_MATH_H

#include "raytracing/shaded_hit.h"
#include "shared/random.h"
#include "shared/rays.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// Direction of a ray, with density cosine over pi about the frame's normal.
LAMBENT_FN vec3 gather_direction(Frame frame, vec2 point) {
  return to_world(frame, sample_cosine_hemisphere(point));
}

// Surfaces that are nearer to each other than probes are light each other with more detail than
// lookups have: light between a lamp and its housing, shade under a bench. Where a gathering ray is
// shorter than a spacing of the probes at its hit, or the light that was drawn there is nearer, a
// secondary gather may replace the lookup there by one more ray: always up to a share of this
// reach, and ever more rarely up to all of it, so that there is no seam. Where that ray meets such
// a place, too, one more follows. Jensen, "Global Illumination using Photon Maps", 1996, sec. 5,
// for nearby hits.
const float kSecondaryReach = 1.0f;  // [spacings]
const float kCertainShare = 0.5f;    // of the reach, up to which there always is one

// Rays that follow a pixel's gathering ray at most: with the light drawn at the last one, five
// bounces between a lamp and its housing.
const int kMaxSecondaryRays = 4;

// Multiples of this salt give the rays of each depth random numbers of their own.
const uint kSecondarySalt = 0x85EBCA6Bu;

/// The salt of rays of a depth, and of the light at their hits. The gathering rays have depth 0 and
/// `salt`, which is the index of the sample or the number of the update; the secondary gathers that
/// follow each other have the depths from 1 on.
LAMBENT_FN uint gather_salt(uint salt, int depth) {
  return salt ^ (uint(depth) * kSecondarySalt);
}

/// The probability of a secondary gather where what is nearest, the origin of the ray that ends
/// there or the light that was drawn, is this far [m], and probes have this spacing [m].
LAMBENT_FN float secondary_probability(float nearest, float spacing) {
  float left = 1.0f - nearest / (kSecondaryReach * spacing);
  return clamp(left / (1.0f - kCertainShare), 0.0f, 1.0f);
}

/// The ray of a secondary gather.
struct SecondaryRay {
  bool traced;  ///< Whether there is one.
  vec3 origin_ws, direction_ws;
};

/// Draws the secondary gather at the hit of a ray. `nearest` and `spacing` are those of
/// secondary_probability(), `index` is that of the gathering ray among all of the picture or
/// update, `salt` the gather_salt() of the new ray, and `seed` that of the light at hits.
LAMBENT_FN SecondaryRay secondary_ray(vec3 position_ws, vec3 normal_ws, vec3 geometric_normal_ws,
                                      float nearest, float spacing, uint index, uint salt,
                                      uint seed) {
  // The complement of the seed: light at its hit draws from the stream of the seed itself
  RandomStream random = make_random_stream(index, salt, ~seed);
  SecondaryRay ray;
  ray.traced = next_uniform(random) < secondary_probability(nearest, spacing);
  ray.origin_ws = offset_ray_origin(position_ws, geometric_normal_ws);
  ray.direction_ws = gather_direction(make_frame(normal_ws), next_uniform2(random));
  return ray;
}

/// Irradiance that one ray gathers whose direction has density cosine over pi. `above` is
/// above_horizon() of the surface, whose geometric normal this is.
LAMBENT_FN vec3 gathered_irradiance(float above, vec3 geometric_normal_ws, vec3 direction_ws,
                                    ShadedHitRecord hit, vec3 direct, vec3 field) {
  // A bent normal's hemisphere reaches below the surface, from where no light comes
  if (dot(geometric_normal_ws, direction_ws) <= 0.0f) return vec3(0.0f);
  return (kPi * above) * gathered_radiance(hit, direct, field);
}

/// Irradiance at the hit of a ray that its secondary gather stands for. The hit's share of indirect
/// light is left to gathered_radiance().
LAMBENT_FN vec3 secondary_irradiance(vec3 normal_ws, vec3 geometric_normal_ws, vec3 direction_ws,
                                     ShadedHitRecord hit, vec3 direct, vec3 field) {
  float above = above_horizon(1.0f, dot(normal_ws, geometric_normal_ws));
  return gathered_irradiance(above, geometric_normal_ws, direction_ws, hit, direct, field);
}

LAMBENT_END
#endif
