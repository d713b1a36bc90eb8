// SPDX-License-Identifier: Apache-2.0
// Conversion between texels of a map and rays of its light. Positions in a map are points of the
// square [-1, 1]^2, x to the right, y up.
#ifndef LAMBENT_RSM_MAPS_PROJECTION_H
#define LAMBENT_RSM_MAPS_PROJECTION_H

#include "rsm/records.h"
#include "shared/octahedral.h"

LAMBENT_BEGIN

/// The middle of texel (x, y) of a map, rows from the top.
LAMBENT_FN vec2 texel_middle(int x, int y, int resolution) {
  float scale = 2.0f / float(resolution);
  return vec2((float(x) + 0.5f) * scale - 1.0f, 1.0f - (float(y) + 0.5f) * scale);
}

/// Position of a point of the square in the map, in texels from its top left corner.
LAMBENT_FN vec2 texel_place(vec2 square, int resolution) {
  float scale = 0.5f * float(resolution);
  return vec2((square.x + 1.0f) * scale, (1.0f - square.y) * scale);
}

/// Direction (not unit) of a perspective map in light space, which looks along -Z.
LAMBENT_FN vec3 perspective_direction(vec2 square, vec2 half_extent) {
  return vec3(square.x * half_extent.x, square.y * half_extent.y, -1.0f);
}

/// The point of the square for a direction of a perspective map; directions outside or behind are
/// clamped to the map's edge.
LAMBENT_FN vec2 perspective_square(vec3 direction, vec2 half_extent) {
  float scale = 1.0f / max(-direction.z, 1e-6f);
  return vec2(clamp(direction.x * scale / half_extent.x, -1.0f, 1.0f),
              clamp(direction.y * scale / half_extent.y, -1.0f, 1.0f));
}

/// Solid angle [sr] of a small part of the square of a perspective map, per area of the square:
/// that of a plane at distance 1, seen obliquely.
LAMBENT_FN float perspective_solid_angle(vec2 square, vec2 half_extent) {
  vec3 direction = perspective_direction(square, half_extent);
  float square_length = dot(direction, direction);
  return half_extent.x * half_extent.y / (square_length * sqrt(square_length));
}

/// The same for an octahedral map. A face of the octahedron is in a plane |x| + |y| + |z| = 1, at
/// distance 1 / sqrt(3), and has sqrt(3) times its area in the square: both factors cancel.
LAMBENT_FN float octahedral_solid_angle(vec2 square) {
  float x = abs(square.x);
  float y = abs(square.y);
  // The fold preserves lengths, so that the lower half may be measured in the square as it is.
  float z = abs(1.0f - x - y);
  if (x + y > 1.0f) {
    float unfolded = 1.0f - y;
    y = 1.0f - x;
    x = unfolded;
  }
  float square_length = x * x + y * y + z * z;
  return 1.0f / (square_length * sqrt(square_length));
}

/// A ray through a point of a map's square.
struct MapRay {
  vec3 origin_ws;     ///< [m]
  vec3 direction_ws;  ///< Unit.
};

LAMBENT_FN MapRay map_ray(MapProjection p, vec2 square) {
  MapRay ray = {p.origin_ws, vec3(0.0f)};
  if (p.kind == kOrthographicMap) {
    vec3 place = vec3(square.x * p.half_extent.x, square.y * p.half_extent.y, 0.0f);
    ray.origin_ws += p.world_from_light * place;
    ray.direction_ws = -p.world_from_light[2];
  } else if (p.kind == kPerspectiveMap) {
    ray.direction_ws = normalize(p.world_from_light * perspective_direction(square, p.half_extent));
  } else {
    ray.direction_ws = p.world_from_light * octahedral_decode(square);
  }
  return ray;
}

/// Area perpendicular to its ray that a texel covers at a distance [m^2].
LAMBENT_FN float perpendicular_area(MapProjection p, vec2 square, int resolution, float dist) {
  float share = 4.0f / (float(resolution) * float(resolution));
  if (p.kind == kOrthographicMap) return share * p.half_extent.x * p.half_extent.y;
  float solid_angle = p.kind == kPerspectiveMap ? perspective_solid_angle(square, p.half_extent)
                                                : octahedral_solid_angle(square);
  return share * solid_angle * (dist * dist);
}

/// Position of a point in the map [texels]; points that the map does not show are at its edge.
LAMBENT_FN vec2 project_to_map(MapProjection p, vec3 position_ws, int resolution) {
  vec3 local = (position_ws - p.origin_ws) * p.world_from_light;
  vec2 square = vec2(0.0f);
  if (p.kind == kOrthographicMap) {
    square = clamp(vec2(local.x, local.y) / p.half_extent, vec2(-1.0f), vec2(1.0f));
  } else if (p.kind == kPerspectiveMap) {
    square = perspective_square(local, p.half_extent);
  } else if (local != vec3(0.0f)) {
    square = octahedral_encode(local);
  }
  return texel_place(square, resolution);
}

LAMBENT_END
#endif
