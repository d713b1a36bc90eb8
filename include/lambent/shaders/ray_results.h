// SPDX-License-Identifier: Apache-2.0
// The results of probe rays that an engine hands to a recorded field (lambent/vulkan_field.h).
// Shaders of engines include this file to turn hits into results. It also declares RayRecord and
// HitRecord.
#ifndef LAMBENT_SHADERS_RAY_RESULTS_H
#define LAMBENT_SHADERS_RAY_RESULTS_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

// What a ray hit.
const uint kRayMetSurface = 0u;
const uint kRayLeft = 1u;         ///< Nothing: the ray left the scene.
const uint kRayMetBackFace = 2u;  ///< The back of a single-sided surface, which sends no light.

/// The result of a ray. Results are in the order of the rays. For a ray that left the scene, only
/// `kind` and `radiance` are read; for one that hit a back face, only `kind`, `distance` and
/// `geometric_normal_ws`. Results of rays with a mask of 0 are not read: such rays need not be
/// traced.
struct RayResult {
  uint kind;
  float distance;            ///< Distance from the ray's origin [m], > 0.
  vec3 normal_ws;            ///< Shading normal; unit, towards the ray's origin.
  vec3 geometric_normal_ws;  ///< Normal of the triangle; unit, towards the ray's origin.
  vec3 albedo;               ///< Diffuse reflectance, 0 to 1, clamped to FieldSettings::max_albedo.
  vec3 direct_irradiance;    ///< Irradiance of the surface directly from lights [W/m^2], >= 0.
  /// Radiance of the sky or emitted by the surface [W/(m^2 sr)], >= 0. It must be 0 for an emissive
  /// surface that `direct_irradiance` includes as a light; otherwise that would light the scene
  /// twice.
  vec3 radiance;
};
LAMBENT_DEVICE_ARRAY(RayResultArray, RayResult, 4)

LAMBENT_FN RayResult ray_left(vec3 sky_radiance) {
  vec3 none = vec3(0.0f);
  RayResult result = {kRayLeft,    uintBitsToFloat(kMissedDistanceBits), none, none, none, none,
                      sky_radiance};
  return result;
}

LAMBENT_FN RayResult ray_met_back_face(float hit_distance, vec3 geometric_normal_ws) {
  vec3 none = vec3(0.0f);
  RayResult result = {
      kRayMetBackFace, hit_distance, geometric_normal_ws, geometric_normal_ws, none, none, none};
  return result;
}

LAMBENT_FN RayResult ray_met_surface(float hit_distance, vec3 normal_ws, vec3 geometric_normal_ws,
                                     vec3 albedo, vec3 direct_irradiance, vec3 emitted_radiance) {
  RayResult result = {kRayMetSurface, hit_distance,      normal_ws,       geometric_normal_ws,
                      albedo,         direct_irradiance, emitted_radiance};
  return result;
}

LAMBENT_END
#endif
