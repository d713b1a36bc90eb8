// SPDX-License-Identifier: Apache-2.0
// A point on an emissive triangle.
#ifndef LAMBENT_SCENE_EMISSIVE_SAMPLE_H
#define LAMBENT_SCENE_EMISSIVE_SAMPLE_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// An emissive triangle.
struct EmitterRecord {
  uint instance;
  uint triangle;
  float area;         ///< World space [m^2].
  float probability;  ///< Of being drawn.
};

/// A point drawn from the emissive triangles.
struct EmissiveSample {
  vec3 position_ws;
  vec3 normal_ws;  ///< Geometric, unit; both sides emit.
  vec3 radiance;   ///< [W/(m^2 sr)].
  float pdf_area;  ///< Density over the area of all emissive triangles [1/m^2]; 0: there are none.
};

LAMBENT_FN EmissiveSample no_emissive_sample() {
  EmissiveSample none = {vec3(0.0f), vec3(0.0f), vec3(0.0f), 0.0f};
  return none;
}

/// Cross product of two edges of a triangle once they are in the world: twice its area long.
LAMBENT_FN vec3 edge_product(mat4 world_from_object, vec3 edge1, vec3 edge2) {
  mat3 linear = mat3(world_from_object);
  return cross(linear * edge1, linear * edge2);
}

LAMBENT_END
#endif
