// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_RAYTRACING_SHADERS_SKY_GLSL
#define LAMBENT_RAYTRACING_SHADERS_SKY_GLSL

#include "raytracing/vulkan/scene_records.h"
#include "scene/latitude_longitude.h"

/// A level of the sky's map, which follows finer ones in the same array.
struct SkyMapLevel {
  Vec3Array texels;
  int first;  ///< The level's first texel.
  int width;
  int height;
};

#define MapRef SkyMapLevel
#define EnvironmentRef EnvironmentRecord
#define SkyRef EnvironmentRecord

vec3 fetch_map(SkyMapLevel map, int x, int y) {
  return map.texels.at[map.first + x + map.width * y];
}

SkyMapLevel map_of(EnvironmentRecord environment) {
  return SkyMapLevel(environment.map.texels, 0, environment.map.width, environment.map.height);
}

EnvironmentRecord environment_of(EnvironmentRecord sky) {
  return sky;
}

SkyMapLevel map_level(EnvironmentRecord sky, int level) {
  SkyMapLevel map = map_of(sky);
  for (int k = 0; k < level; ++k) {
    map.first += map.width * map.height;
    map.width = map_level_size(sky.map.width, k + 1);
    map.height = map_level_size(sky.map.height, k + 1);
  }
  return map;
}

/// The levels without the bright part follow all levels of the map; the first is level 1.
SkyMapLevel dim_level(EnvironmentRecord sky, int level) {
  int levels = map_level_count(sky.map.height);
  SkyMapLevel map = map_level(sky, level);
  SkyMapLevel coarsest = map_level(sky, levels - 1);
  map.first += coarsest.first + coarsest.width * coarsest.height - sky.map.width * sky.map.height;
  return map;
}

float bright_limit(EnvironmentRecord sky) {
  return sky.bright_limit;
}
float bright_total(EnvironmentRecord sky) {
  return sky.bright_total;
}
uint bright_cell_count(EnvironmentRecord sky) {
  return sky.bright_cell_count;
}
BrightSkyCell fetch_bright_cell(EnvironmentRecord sky, uint cell) {
  return sky.bright_cells.at[cell];
}

#include "scene/sky/bright_sky.inl.h"

#endif
