// SPDX-License-Identifier: Apache-2.0
// An emissive triangle, or a piece of one, as a light.
#ifndef LAMBENT_SCENE_EMISSIVE_SAMPLE_H
#define LAMBENT_SCENE_EMISSIVE_SAMPLE_H

#include "shared/layers.h"

LAMBENT_BEGIN

/// An emissive triangle, or a piece of one that is similar to it and a power of two smaller.
struct EmitterRecord {
  uint instance;
  uint triangle;
  float area;         ///< World space [m^2].
  float probability;  ///< Of being drawn by power.
  vec3 corner_ws;     ///< Its first corner [m]; the edges lead from it to the others.
  vec3 edge1_ws;
  vec3 edge2_ws;
  vec2 piece_corner;  ///< Barycentrics of that corner in the whole triangle.
  float piece_size;   ///< Ratio of its edges to the whole triangle's; < 0: reversed.
};

// The squared length of the cross product of two edges may be too small for a float. Where it is
// below this [m^4], the edges are first scaled by a power of two, which is exact.
const float kLeastSquaredProduct = 1e-30f;
const float kShortEdgeScale = 1099511627776.0f;  // 2^40

/// Whether a triangle is so small that its edges are to be scaled.
LAMBENT_FN bool has_short_edges(vec3 edge1, vec3 edge2) {
  vec3 product = cross(edge1, edge2);
  return dot(product, product) < kLeastSquaredProduct;
}

/// Area of a triangle by two of its edges, in their unit squared; 0 where they are parallel.
LAMBENT_FN float triangle_area(vec3 edge1, vec3 edge2) {
  if (!has_short_edges(edge1, edge2)) return 0.5f * length(cross(edge1, edge2));
  float scaled = 0.5f * length(cross(kShortEdgeScale * edge1, kShortEdgeScale * edge2));
  return scaled / (kShortEdgeScale * kShortEdgeScale);
}

/// Unit normal of a triangle by two of its edges, which are not parallel.
LAMBENT_FN vec3 triangle_normal(vec3 edge1, vec3 edge2) {
  if (!has_short_edges(edge1, edge2)) return normalize(cross(edge1, edge2));
  return normalize(cross(kShortEdgeScale * edge1, kShortEdgeScale * edge2));
}

/// Converts barycentrics in the emitter to those in the whole triangle.
LAMBENT_FN vec2 barycentrics_in_triangle(EmitterRecord emitter, vec2 barycentrics) {
  return emitter.piece_corner + emitter.piece_size * barycentrics;
}

LAMBENT_END
#endif
