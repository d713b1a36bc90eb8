// SPDX-License-Identifier: Apache-2.0
// From what a ray of a map met to its texel.
#ifndef LAMBENT_RSM_MAPS_MAP_TEXEL_H
#define LAMBENT_RSM_MAPS_MAP_TEXEL_H

#include "rsm/geometry_term.h"
#include "rsm/records.h"
#include "shared/brdf.h"

LAMBENT_BEGIN

// A shading normal tilted away from its triangle changes the light on it by at most this factor:
// beyond, the light grazes the triangle, and few texels would bring enormous light.
const float kMaxTilt = 4.0f;
const float kMinGrazingCosine = 1e-3f;  // bounds a texel's area likewise

/// A texel that saw nothing.
LAMBENT_FN RsmTexelRecord empty_texel() {
  RsmTexelRecord texel = {vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, vec3(0.0f), 0.0f};
  return texel;
}

/// A texel that stands for a piece of a surface and reflects so much.
LAMBENT_FN RsmTexelRecord make_texel(vec3 position_ws, vec3 normal_ws, float area, vec3 flux) {
  RsmTexelRecord texel = {position_ws + normal_ws * (kTexelOffset * sqrt(area)),
                          area,
                          normal_ws,
                          kSofteningPerArea * area,
                          flux,
                          0.0f};
  return texel;
}

/// Cosine between a triangle and the ray that met it, as texels' areas are found with.
LAMBENT_FN float grazing_cosine(vec3 geometric_normal_ws, vec3 ray_direction_ws) {
  return max(kMinGrazingCosine, -dot(geometric_normal_ws, ray_direction_ws));
}

/// The texel of a surface that a light's ray met. `irradiance` is the light's, on a surface
/// perpendicular to the ray; `cross_section` the texel's area, likewise [m^2]. Light is reflected
/// as the shading normal receives it, but sent out from the triangle: texels of one bumpy wall must
/// not light each other.
LAMBENT_FN RsmTexelRecord lit_texel(vec3 position_ws, vec3 normal_ws, vec3 geometric_normal_ws,
                                    Reflectance reflectance, vec3 ray_direction_ws, vec3 irradiance,
                                    float cross_section) {
  float grazing = grazing_cosine(geometric_normal_ws, ray_direction_ws);
  float received = max(0.0f, -dot(normal_ws, ray_direction_ws));
  vec3 albedo = effective_albedo(reflectance, received);
  float tilt = min(kMaxTilt, received / grazing);
  return make_texel(position_ws, geometric_normal_ws, cross_section / grazing,
                    albedo * irradiance * (cross_section * tilt));
}

/// The texel of a surface that a camera's ray met and that sends back that radiance, evenly.
LAMBENT_FN RsmTexelRecord seen_texel(vec3 position_ws, vec3 geometric_normal_ws,
                                     vec3 ray_direction_ws, vec3 radiance, float cross_section) {
  float area = cross_section / grazing_cosine(geometric_normal_ws, ray_direction_ws);
  if (!(area > 0.0f)) return empty_texel();
  return make_texel(position_ws, geometric_normal_ws, area, radiance * (kPi * area));
}

LAMBENT_END
#endif
