// SPDX-License-Identifier: Apache-2.0
// Directions as points of a latitude-longitude map.
#ifndef LAMBENT_SCENE_LATITUDE_LONGITUDE_H
#define LAMBENT_SCENE_LATITUDE_LONGITUDE_H

#include "shared/constants.h"

LAMBENT_BEGIN

// Largest float below 1: keeps uv inside the last cell.
const float kBelowOne = 0.99999994f;

/// The point of a latitude-longitude map for a unit direction: u to the right, v down from +Y, both
/// 0 to 1. Without rotation, the middle of the map is -Z and +X is right of it; `rotation` turns
/// the sky about +Y [rad].
LAMBENT_FN vec2 latitude_longitude_from_direction(vec3 direction_ws, float rotation) {
  // A turn by +rotation about +Y takes -Z towards -X, which is to the left in the map
  float longitude = atan(direction_ws.x, -direction_ws.z) + rotation;
  float turns = longitude / kTwoPi + 0.5f;
  float theta = acos(clamp(direction_ws.y, -1.0f, 1.0f));
  return vec2(min(turns - floor(turns), kBelowOne), theta * kInvPi);
}

/// The unit direction for a point of the map. Inverse of latitude_longitude_from_direction.
LAMBENT_FN vec3 direction_from_latitude_longitude(vec2 uv, float rotation) {
  float longitude = (uv.x - 0.5f) * kTwoPi - rotation;
  float theta = uv.y * kPi;
  float radius = sin(theta);
  return vec3(radius * sin(longitude), cos(theta), -radius * cos(longitude));
}

/// The four texels around a point of a map, and its fractional position between them. Wraps around
/// in u, clamps in v.
struct MapTexels {
  int left;
  int right;
  int top;
  int bottom;
  vec2 fraction;
};

LAMBENT_FN MapTexels map_texels(vec2 uv, int width, int height) {
  float x = uv.x * float(width) - 0.5f;
  float y = uv.y * float(height) - 0.5f;
  float left = floor(x);
  float top = floor(y);
  int x0 = int(left) + width;
  int y0 = int(top);
  MapTexels texels = {x0 % width, (x0 + 1) % width, clamp(y0, 0, height - 1),
                      clamp(y0 + 1, 0, height - 1), vec2(x - left, y - top)};
  return texels;
}

// Rows of a map's coarsest level, at least: its texels are an eighth of a turn wide and high.
const int kCoarsestRows = 4;

/// How many levels a map of so many rows has, each of half the rows and columns of the one before.
LAMBENT_FN int map_level_count(int height) {
  int levels = 1;
  for (int rows = height / 2; rows >= kCoarsestRows; rows /= 2) ++levels;
  return levels;
}

/// Columns or rows of a level of a map that has `size` of them.
LAMBENT_FN int map_level_size(int size, int level) {
  return max(size >> level, 1);
}

/// Two levels of a map, and the weight of the coarser one.
struct BlendedLevels {
  int finer;
  int coarser;
  float fraction;
};

/// The levels of a map of this height [texels] that a cone of this angle [rad] blends.
LAMBENT_FN BlendedLevels levels_of_cone(int height, float angle) {
  int coarsest = map_level_count(height) - 1;
  float texels = angle * float(height) * kInvPi;
  float level = clamp(log2(max(texels, 1.0f)), 0.0f, float(coarsest));
  int finer = min(int(level), coarsest);
  BlendedLevels levels = {finer, min(finer + 1, coarsest), level - float(finer)};
  return levels;
}

LAMBENT_END
#endif
