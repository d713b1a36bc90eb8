// SPDX-License-Identifier: Apache-2.0
// What rays bring back, but for the light that arrives where they end.
#ifndef LAMBENT_RAYTRACING_SHADED_HIT_H
#define LAMBENT_RAYTRACING_SHADED_HIT_H

#include "raytracing/surface_math.h"

LAMBENT_BEGIN

// Flags of ShadedHitRecord and PixelSurfaceRecord.
const uint kSurfaceMissed = 1u;      ///< The ray left the scene.
const uint kSurfaceDiscounted = 2u;  ///< The side that the ray met bounds solid matter: the ray
                                     ///< does not count.

// Rays that gather a hemisphere's light have cones this wide per metre over the square root of
// their number: together they cover it.
const float kHemisphereConeWidth = 2.0f;

/// What a ray brings back but for its direct light and its point.
struct ShadedHitRecord {
  vec3 albedo_over_pi;  ///< Diffuse and specular together [1/sr]; 0: reflects nothing.
  vec3 radiance;        ///< Emitted, or the sky's where the ray left the scene [W/(m^2 sr)].
  uint material;        ///< Index into Scene::materials; 0 where the ray left the scene.
  uint flags;
  float gi_share;  ///< As in Surface; 0 where the ray left the scene.
};

/// Of a ray that left the scene.
LAMBENT_FN ShadedHitRecord shaded_sky(vec3 sky_radiance) {
  ShadedHitRecord hit = {vec3(0.0f), sky_radiance, 0u, kSurfaceMissed, 0.0f};
  return hit;
}

/// Of a ray that met a surface. `from_inside` 1: the ray met a side that bounds solid matter, and
/// such rays do not count.
LAMBENT_FN ShadedHitRecord shaded_surface(Surface surface, vec3 direction_ws, float max_albedo,
                                          uint from_inside) {
  ShadedHitRecord hit = {vec3(0.0f), vec3(0.0f), surface.material, kSurfaceDiscounted, 0.0f};
  if (from_inside != 0u) return hit;
  hit.flags = 0u;
  hit.gi_share = surface.gi_share;
  hit.radiance = surface.emission;
  float n_dot_v = -dot(surface.normal_ws, direction_ws);
  vec3 albedo = min(effective_albedo(surface.reflectance, n_dot_v), vec3(max_albedo));
  hit.albedo_over_pi = albedo * kInvPi;
  return hit;
}

/// What a hit brings to a ray that came through glass, which lets this share of light pass.
/// `weight` is that of a ray which was stopped although it might have passed, else 1.
LAMBENT_FN ShadedHitRecord seen_through_glass(ShadedHitRecord hit, vec3 share, float weight,
                                              float max_albedo) {
  hit.albedo_over_pi = share * min(weight * hit.albedo_over_pi, vec3(max_albedo * kInvPi));
  hit.radiance *= weight * share;
  return hit;
}

/// Radiance that a gathering ray brings back but for what its hit emits, which is direct light.
/// `direct` and `field` are the irradiance of the hit from lights and from the field.
LAMBENT_FN vec3 gathered_radiance(ShadedHitRecord hit, vec3 direct, vec3 field) {
  bool sky = (hit.flags & kSurfaceMissed) != 0u;
  return hit.albedo_over_pi * (direct + hit.gi_share * field) + (sky ? hit.radiance : vec3(0.0f));
}

LAMBENT_END
#endif
