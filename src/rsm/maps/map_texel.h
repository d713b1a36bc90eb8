// SPDX-License-Identifier: Apache-2.0
// The texel for a hit of a map's ray.
#ifndef LAMBENT_RSM_MAPS_MAP_TEXEL_H
#define LAMBENT_RSM_MAPS_MAP_TEXEL_H

#include "rsm/records.h"
#include "rsm/texel_light.h"
#include "shared/brdf.h"

LAMBENT_BEGIN

// Largest factor by which a shading normal tilted away from its triangle changes the light on it:
// beyond it, the light grazes the triangle, and few texels would have enormous light.
const float kMaxTilt = 4.0f;
const float kMinGrazingCosine = 1e-3f;  // likewise bounds a texel's area

/// The texel of a ray that hit nothing.
LAMBENT_FN RsmTexelRecord empty_texel() {
  RsmTexelRecord texel = {vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, vec3(0.0f), 0.0f};
  return texel;
}

/// A texel that represents a part of a surface and reflects this flux.
LAMBENT_FN RsmTexelRecord make_texel(vec3 position_ws, vec3 normal_ws, float area, vec3 flux) {
  RsmTexelRecord texel = {position_ws + normal_ws * (kTexelOffset * sqrt(area)),
                          area,
                          normal_ws,
                          kSofteningPerArea * area,
                          flux,
                          0.0f};
  return texel;
}

/// Cosine between a triangle and the ray that hit it, as used for the areas of texels.
LAMBENT_FN float grazing_cosine(vec3 geometric_normal_ws, vec3 ray_direction_ws) {
  return max(kMinGrazingCosine, -dot(geometric_normal_ws, ray_direction_ws));
}

/// The texel of a surface that a light's ray hit. `irradiance`: that of the light, on a surface
/// perpendicular to the ray; `cross_section`: the texel's area perpendicular to the ray [m^2].
/// Light is received by the shading normal, but sent out from the triangle: texels of one bumpy
/// wall must not light each other.
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

/// The texel of a surface that a camera's ray hit and that reflects this radiance, in all
/// directions.
LAMBENT_FN RsmTexelRecord seen_texel(vec3 position_ws, vec3 geometric_normal_ws,
                                     vec3 ray_direction_ws, vec3 radiance, float cross_section) {
  float area = cross_section / grazing_cosine(geometric_normal_ws, ray_direction_ws);
  if (!(area > 0.0f)) return empty_texel();
  return make_texel(position_ws, geometric_normal_ws, area, radiance * (kPi * area));
}

LAMBENT_END
#endif
