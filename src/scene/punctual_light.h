// SPDX-License-Identifier: Apache-2.0
// Light from sources without extent. Based on: Khronos Group, KHR_lights_punctual.
#ifndef LAMBENT_SCENE_PUNCTUAL_LIGHT_H
#define LAMBENT_SCENE_PUNCTUAL_LIGHT_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// The values of Light::Type in scene.h.
const uint kLightDirectional = 0u;
const uint kLightPoint = 1u;
const uint kLightSpot = 2u;

/// A light in the form that shared mathematics uses; see struct Light of scene.h.
struct LightRecord {
  vec3 intensity;     ///< Directional: irradiance [W/m^2]; else radiant intensity [W/sr].
  uint type;          ///< kLightDirectional, ...
  vec3 position_ws;   ///< [m]
  float range;        ///< [m]; 0: infinite.
  vec3 direction_ws;  ///< Direction in which the light travels; unit.
  float cos_outer;    ///< Cosine of a spot light's outer cone angle.
  float cone_scale;   ///< Of a spot light: factor that maps cosines above cos_outer to 0 to 1.
};

/// Light that reaches a point from a light without extent.
struct PunctualSample {
  vec3 irradiance;  ///< On a surface perpendicular to `to_light`, unoccluded [W/m^2].
  vec3 to_light;    ///< Unit.
  float distance;   ///< To the light [m]; infinite for directional lights.
};

// Cosines of the two cone angles closer than this count as equal, as KHR_lights_punctual
// recommends.
const float kMinConeCosineRange = 1e-3f;

/// Irradiance of lights without extent is clamped to this [W/m^2]: inverse squares grow without
/// bound near a light, and the square of a sum of such samples must be finite in a float.
const float kMaxPunctualIrradiance = 1e10f;
/// Points at a smaller squared distance [m^2] count as inside the light and receive nothing. Its
/// inverse is finite in a float.
const float kMinSquaredLightDistance = 1e-30f;

/// KHR_lights_punctual, "Inner and Outer Cone Angles": LightRecord::cone_scale.
LAMBENT_FN float cone_scale(float cos_inner, float cos_outer) {
  return 1.0f / max(kMinConeCosineRange, cos_inner - cos_outer);
}

LAMBENT_FN float cone_attenuation(LightRecord light, vec3 to_light) {
  float cosine = -dot(light.direction_ws, to_light);
  float falloff = clamp((cosine - light.cos_outer) * light.cone_scale, 0.0f, 1.0f);
  return falloff * falloff;
}

/// KHR_lights_punctual, "Range Property".
LAMBENT_FN float range_attenuation(float range, float distance) {
  if (range <= 0.0f) return 1.0f;
  float share = distance / range;
  return clamp(1.0f - share * share * share * share, 0.0f, 1.0f);
}

/// The unoccluded light from `light` at a point; irradiance 0 outside its cone or range.
LAMBENT_FN PunctualSample sample_punctual(LightRecord light, vec3 position_ws) {
  PunctualSample result = {vec3(0.0f), vec3(0.0f), 0.0f};
  if (light.type == kLightDirectional) {
    result.irradiance = light.intensity;
    result.to_light = -light.direction_ws;
    result.distance = infinity();
    return result;
  }
  vec3 offset = light.position_ws - position_ws;
  float squared_distance = dot(offset, offset);
  if (squared_distance < kMinSquaredLightDistance) return result;
  result.distance = sqrt(squared_distance);
  result.to_light = offset / result.distance;
  float attenuation = range_attenuation(light.range, result.distance);
  if (light.type == kLightSpot) attenuation *= cone_attenuation(light, result.to_light);
  result.irradiance =
      min(light.intensity * (attenuation / squared_distance), vec3(kMaxPunctualIrradiance));
  return result;
}

LAMBENT_END
#endif
