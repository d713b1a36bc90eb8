// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_RAYTRACING_SHADERS_SKY_GLSL
#define LAMBENT_RAYTRACING_SHADERS_SKY_GLSL

#include "raytracing/vulkan/scene_records.h"
#include "scene/latitude_longitude.h"

#define MapRef EnvironmentMapRecord
#define EnvironmentRef EnvironmentRecord

vec3 fetch_map(EnvironmentMapRecord map, int x, int y) {
  return map.texels.at[x + map.width * y];
}

#include "scene/environment.inl.h"

#endif
