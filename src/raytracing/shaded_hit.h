// SPDX-License-Identifier: Apache-2.0
// What rays bring back, but for the light that arrives where they end.
#ifndef LAMBENT_RAYTRACING_SHADED_HIT_H
#define LAMBENT_RAYTRACING_SHADED_HIT_H

#include "raytracing/surface_math.h"

LAMBENT_BEGIN

// Flags of ShadedHitRecord and PixelSurfaceRecord.
const uint kSurfaceMissed = 1u;  ///< The ray left the scene.
const uint kSurfaceDiscounted =
    2u;  ///< The back of a single-sided surface: the ray does not count.
const uint kSurfaceReceivesGi = 4u;  ///< Indirect light reaches the surface.

/// What a ray brings back but for its direct light and its point.
struct ShadedHitRecord {
  vec3 albedo_over_pi;  ///< Diffuse and specular together [1/sr]; 0: reflects nothing.
  vec3 radiance;        ///< Emitted, or the sky's where the ray left the scene [W/(m^2 sr)].
  uint material;        ///< Index into Scene::materials; 0 where the ray left the scene.
  uint flags;
};

/// Of a ray that left the scene.
LAMBENT_FN ShadedHitRecord shaded_sky(vec3 sky_radiance) {
  ShadedHitRecord hit = {vec3(0.0f), sky_radiance, 0u, kSurfaceMissed | kSurfaceReceivesGi};
  return hit;
}

/// Of a ray that met a surface. `back_faces_count` 1: single-sided surfaces are lit from behind,
/// too.
LAMBENT_FN ShadedHitRecord shaded_surface(Surface surface, vec3 direction_ws, float max_albedo,
                                          uint back_faces_count) {
  ShadedHitRecord hit = {vec3(0.0f), vec3(0.0f), surface.material,
                         kSurfaceDiscounted | kSurfaceReceivesGi};
  if (!surface.front_face && !surface.double_sided && back_faces_count == 0u) return hit;
  hit.flags = surface.receives_gi ? kSurfaceReceivesGi : 0u;
  hit.radiance = surface.emission;
  float n_dot_v = -dot(surface.normal_ws, direction_ws);
  vec3 albedo = min(effective_albedo(surface.reflectance, n_dot_v), vec3(max_albedo));
  hit.albedo_over_pi = albedo * kInvPi;
  return hit;
}

LAMBENT_END
#endif
