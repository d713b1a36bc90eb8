// SPDX-License-Identifier: Apache-2.0
// What an engine tells of the rays that a recorded field asked for (lambent/vulkan_field.h). All
// that an engine's shader includes to turn hits into these; RayRecord and HitRecord come with it.
#ifndef LAMBENT_SHADERS_RAY_RESULTS_H
#define LAMBENT_SHADERS_RAY_RESULTS_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

// What a ray ended at.
const uint kRayMetSurface = 0u;
const uint kRayLeft = 1u;         ///< It met nothing.
const uint kRayMetBackFace = 2u;  ///< The back of a single-sided surface: it brings no light.

/// What a ray brings back, in the order of the rays. Of a ray that left, `kind` and `radiance` are
/// read; of one that met a back face, `kind`, `distance` and `geometric_normal_ws`. Those of rays
/// whose mask is 0 are not read: such rays need not be traced.
struct RayResult {
  uint kind;
  float distance;            ///< From the ray's origin [m], > 0.
  vec3 normal_ws;            ///< That light is reflected by; unit, towards the ray's origin.
  vec3 geometric_normal_ws;  ///< The triangle's; unit, likewise.
  vec3 albedo;               ///< Diffuse reflectance, 0 to 1; FieldSettings::max_albedo at most.
  vec3 direct_irradiance;    ///< On the surface, straight from lights [W/m^2], >= 0.
  /// Of the sky, or of what glows [W/(m^2 sr)], >= 0. What glows and counts as a light in
  /// `direct_irradiance` tells 0 here, or it would light twice.
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
