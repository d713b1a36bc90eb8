// SPDX-License-Identifier: Apache-2.0
// Triangles on the unit sphere: their solid angles, and uniform sampling of directions in them.
// Based on: Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995.
#ifndef LAMBENT_SHARED_SPHERICAL_TRIANGLE_H
#define LAMBENT_SHARED_SPHERICAL_TRIANGLE_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// A triangle on the unit sphere, by its corners.
struct SphericalTriangle {
  vec3 a;
  vec3 b;
  vec3 c;
  float volume;       ///< |a . (b x c)|; 0: all corners are on one great circle.
  float solid_angle;  ///< [sr], 0 to 2 pi.
};

/// The triangle between three unit vectors.
/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE TBME 30(2), 1983.
LAMBENT_FN SphericalTriangle spherical_triangle(vec3 a, vec3 b, vec3 c) {
  // Differences of corners that are close together are exact, but products are not
  float volume = abs(dot(a, cross(b - a, c - a)));
  float solid_angle = 2.0f * atan(volume, 1.0f + dot(a, b) + dot(b, c) + dot(c, a));
  SphericalTriangle triangle = {a, b, c, volume, solid_angle};
  return triangle;
}

/// A direction within the triangle, for a uniform point of the unit square. Its density is
/// 1 / solid_angle.
///
/// The arc from b to a point c' of the arc from a to c cuts off the share u.x of the triangle. Let
/// w be half of the cut-off solid angle and r = x a + y c on the bisector of a and c'. Then
///
///     tan w = det(a, b, c') / (1 + a.b + b.c' + c'.a) = det(a, b, r) / ((a + b) . r)
///
/// and with det(a, b, r) = y det(a, b, c) this holds for
///
///     x = cos w |det(a, b, c)| - sin w (a.c + b.c)   and   y = sin w (1 + a.b).
///
/// On the arc from b to c', areas grow with 1 minus the cosine of the angle from b.
LAMBENT_FN vec3 sample_spherical_triangle(SphericalTriangle triangle, vec2 u) {
  float w = 0.5f * triangle.solid_angle * u.x;
  float a_dot_c = dot(triangle.a, triangle.c);
  float x = cos(w) * triangle.volume - sin(w) * (a_dot_c + dot(triangle.b, triangle.c));
  float y = sin(w) * (1.0f + dot(triangle.a, triangle.b));
  float squared = x * x + 2.0f * x * y * a_dot_c + y * y;
  if (squared <= 0.0f) return triangle.b;
  vec3 bisector = x * triangle.a + y * triangle.c;
  vec3 end = (2.0f * (x + y * a_dot_c) / squared) * bisector - triangle.a;

  // Differences from 1 are computed directly, since cosines between close corners round to 1
  vec3 chord = end - triangle.b;
  float whole = 0.5f * dot(chord, chord);
  float part = u.y * whole;
  float along = whole < 2.0f ? sqrt(u.y * (2.0f - part) / (2.0f - whole)) : 0.0f;
  return triangle.b * (1.0f - part - along * (1.0f - whole)) + along * end;
}

LAMBENT_END
#endif
