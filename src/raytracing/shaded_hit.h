// SPDX-License-Identifier: Apache-2.0
// The shading of a ray's hit, without the light that arrives there.
#ifndef LAMBENT_RAYTRACING_SHADED_HIT_H
#define LAMBENT_RAYTRACING_SHADED_HIT_H

#include "raytracing/surface_math.h"
#include "shared/albedo_shape.h"

LAMBENT_BEGIN

// Flags of ShadedHitRecord and PixelSurfaceRecord.
const uint kSurfaceMissed = 1u;  ///< The ray left the scene.
/// The ray hit a side that bounds solid matter: it does not count.
const uint kSurfaceDiscounted = 2u;
/// Lights behind the surface are sampled, see samples_lights_behind().
const uint kSurfaceSamplesBehind = 4u;
/// The pixel has no sample, see SampleRound: no ray was traced, and it shows nothing.
const uint kSurfaceSkipped = 8u;
/// Rays gather the indirect light of the surface's base, in place of the lookup.
const uint kSurfaceGathers = 16u;

// Rays that gather a hemisphere's light have cones this wide per metre over the square root of
// their number: together they cover the hemisphere.
const float kHemisphereConeWidth = 2.0f;

/// The shading of a ray's hit without its direct light and its point.
struct ShadedHitRecord {
  vec3 albedo_over_pi;  ///< Diffuse and specular albedo over pi [1/sr]; 0: reflects nothing.
  vec3 radiance;        ///< Emission, or the sky's where the ray left the scene [W/(m^2 sr)].
  uint material;        ///< Index into Scene::materials; 0 where the ray left the scene.
  uint flags;
  float gi_share;  ///< See Surface; 0 where the ray left the scene.
  /// Where the ray met a mirror (mirrors/mirror_math.h) and went on: the mirror's distance from the
  /// ray's origin [m]. The rest describes what the mirror shows. 0: the ray met none.
  float mirror_distance;
};

/// The record of a ray that left the scene.
LAMBENT_FN ShadedHitRecord shaded_sky(vec3 sky_radiance) {
  ShadedHitRecord hit = {vec3(0.0f), sky_radiance, 0u, kSurfaceMissed, 0.0f, 0.0f};
  return hit;
}

/// The record of a ray that hit a surface. `max_albedo` bounds the surface's mean albedo.
/// `from_inside` 1: the ray hit a side that bounds solid matter, and is discounted.
LAMBENT_FN ShadedHitRecord shaded_surface(Surface surface, vec3 direction_ws, float max_albedo,
                                          uint from_inside) {
  ShadedHitRecord hit = {vec3(0.0f), vec3(0.0f), surface.material, kSurfaceDiscounted, 0.0f, 0.0f};
  if (from_inside != 0u) return hit;
  hit.flags = 0u;
  hit.gi_share = surface.gi_share;
  hit.radiance = surface.emission;
  float n_dot_v = -dot(surface.normal_ws, direction_ws);
  hit.albedo_over_pi = bounded_albedo(surface.reflectance, n_dot_v, max_albedo) * kInvPi;
  return hit;
}

/// The record of a hit seen through glass that transmits this share of light. `weight`: that of a
/// ray which a transmissive surface stopped although it might have passed, else 1: such a weight
/// raises the albedo to `max_albedo` at most.
LAMBENT_FN ShadedHitRecord seen_through_glass(ShadedHitRecord hit, vec3 share, float weight,
                                              float max_albedo) {
  vec3 most = max(hit.albedo_over_pi, vec3(max_albedo * kInvPi));
  hit.albedo_over_pi = share * min(weight * hit.albedo_over_pi, most);
  hit.radiance *= weight * share;
  return hit;
}

/// Whether a lookup of the field at a hit adds to the light that its ray brings.
LAMBENT_FN bool reads_field(ShadedHitRecord hit) {
  return hit.gi_share > 0.0f && hit.albedo_over_pi != vec3(0.0f);
}

/// Radiance that a gathering ray contributes, without its hit's emission, which is direct light.
/// `direct` and `field`: irradiance at the hit from lights and from the field; the latter is read
/// where the hit reads_field() alone.
LAMBENT_FN vec3 gathered_radiance(ShadedHitRecord hit, vec3 direct, vec3 field) {
  bool sky = (hit.flags & kSurfaceMissed) != 0u;
  vec3 indirect = reads_field(hit) ? hit.gi_share * field : vec3(0.0f);
  return hit.albedo_over_pi * (direct + indirect) + (sky ? hit.radiance : vec3(0.0f));
}

LAMBENT_END
#endif
