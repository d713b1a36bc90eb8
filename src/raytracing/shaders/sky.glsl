// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_RAYTRACING_SHADERS_SKY_GLSL
#define LAMBENT_RAYTRACING_SHADERS_SKY_GLSL

#include "raytracing/vulkan/scene_records.h"
#include "scene/latitude_longitude.h"

/// Radiance of the sky in a unit direction [W/(m^2 sr)].
vec3 sky_radiance(SceneArray scene, vec3 direction_ws) {
  int width = scene.at[0].sky_width;
  if (width == 0) return scene.at[0].sky_radiance;
  vec2 uv = latitude_longitude_from_direction(direction_ws, scene.at[0].sky_rotation);
  MapTexels t = map_texels(uv, width, scene.at[0].sky_height);
  Vec3Array map = scene.at[0].sky_map;
  vec3 above = mix(map.at[t.left + width * t.top], map.at[t.right + width * t.top], t.fraction.x);
  vec3 below =
      mix(map.at[t.left + width * t.bottom], map.at[t.right + width * t.bottom], t.fraction.x);
  return scene.at[0].sky_radiance * mix(above, below, t.fraction.y);
}

#endif
