// SPDX-License-Identifier: Apache-2.0
// The engine's shading of what probes' rays met: walls of one colour each, lit by one lamp. The
// room is convex, so that the lamp needs no shadow rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ray_results.h"

struct Wall {
  vec3 normal;  // into the room, unit
  vec3 albedo;
};
LAMBENT_DEVICE_ARRAY(Walls, Wall, 4)

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  RayArray rays;
  HitArray hits;
  RayResultArray results;
  Walls walls;
  vec3 lamp_ws;
  float lamp_intensity;  // [W/sr]
  uint count;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count || rays.at[i].mask == 0u) return;
  RayRecord ray = rays.at[i];
  HitRecord hit = hits.at[i];
  if (missed(hit)) {
    results.at[i] = ray_left(vec3(0.0));
    return;
  }
  Wall wall = walls.at[hit.instance];
  if (hit.front_face == 0u) {
    results.at[i] = ray_met_back_face(hit.distance, -wall.normal);
    return;
  }
  vec3 to_lamp = lamp_ws - (ray.origin_ws + hit.distance * ray.direction_ws);
  float away = length(to_lamp);
  float irradiance = lamp_intensity * max(0.0, dot(wall.normal, to_lamp / away)) / (away * away);
  results.at[i] = ray_met_surface(hit.distance, wall.normal, wall.normal, wall.albedo,
                                  vec3(irradiance), vec3(0.0));
}
