// SPDX-License-Identifier: Apache-2.0
// Based on: Dachsbacher and Stamminger, "Reflective Shadow Maps", I3D 2005. The light from a texel
// to a point, bounded where the two are close.
#ifndef LAMBENT_RSM_TEXEL_LIGHT_H
#define LAMBENT_RSM_TEXEL_LIGHT_H

#include "shared/constants.h"

LAMBENT_BEGIN

/// Dachsbacher and Stamminger 2005, Eq. 1, over pi: irradiance [1/m^2] at a point with a normal for
/// each watt that a texel's Lambert surface reflects. Unbounded where the two are close.
LAMBENT_FN float geometry_term(vec3 position_ws, vec3 normal_ws, vec3 texel_ws,
                               vec3 texel_normal_ws) {
  vec3 to_texel = texel_ws - position_ws;
  float above_texel = -dot(texel_normal_ws, to_texel);
  float above_point = dot(normal_ws, to_texel);
  if (above_texel <= 0.0f || above_point <= 0.0f) return 0.0f;
  float square = dot(to_texel, to_texel);
  return kInvPi * above_texel * above_point / (square * square);
}

// The bounded term. With u and v the heights of the point over the texel's plane and of the texel
// over the point's, d their distance and e the softening [m^2],
//
//     K = (u v + e k) / (pi (d^2 + e)^2)
//
// stays below 1 / (pi e) * (k + 1/4). Alone, e would darken what is close, corners above all; k is
// chosen so that on average it does not. Let point and texel run over two half-planes that share an
// edge, at an angle p seen from between them. Along the edge both terms integrate to half of
// 1 / D^3 and 1 / (D^2 + e)^(3/2), D their distance across it. What softening takes, summed over
// both half-planes across the edge in polar coordinates (R, t) with a = R cos t, r = R sin t,
// D^2 = R^2 (1 - c sin 2t), c = cos p, must be what k gives:
//
//     sin^2 p  INT sin 2t / (1 - c sin 2t)^2 dt  =  k  INT 1 / (1 - c sin 2t) dt,   0 < t < pi / 2
//
// The right integral is I(c) = (pi - p) / sin p, the left one dI / dc, so
//
//     | k(p) = cos p + sin p / (pi - p) |
//
// 1 for planes that face each other (there it conserves light at every distance), 2 / pi for a
// corner of a room, 0 for one plane. c is minus the cosine between the normals. A polynomial
// replaces the angle: exact at these three, within 0.07 between them.
const float kSofteningCorner = 0.6366f;
const float kSofteningLinear = 0.6155f;
const float kSofteningSquare = -0.1366f;
const float kSofteningCube = -0.1155f;

/// A point that gathers light: position [m] and unit normal.
struct PointNumbers {
  float x, y, z, nx, ny, nz;
};

LAMBENT_FN PointNumbers point_numbers(vec3 position_ws, vec3 normal_ws) {
  PointNumbers point = {position_ws.x, position_ws.y, position_ws.z,
                        normal_ws.x,   normal_ws.y,   normal_ws.z};
  return point;
}

#define Real float
#define TexelReal float
#define LAMBENT_REAL_FN LAMBENT_FN
#include "rsm/texel_light.inl.h"
#undef Real
#undef TexelReal
#undef LAMBENT_REAL_FN

LAMBENT_FN TexelNumbers texel_numbers(vec3 position_ws, vec3 normal_ws, float softening) {
  TexelNumbers texel = {position_ws.x, position_ws.y, position_ws.z, normal_ws.x,
                        normal_ws.y,   normal_ws.z,   softening};
  return texel;
}

/// geometry_term(), bounded as derived above. `softening`: [m^2], > 0.
LAMBENT_FN float bounded_geometry_term(vec3 position_ws, vec3 normal_ws, vec3 texel_ws,
                                       vec3 texel_normal_ws, float softening) {
  TexelSight sight = see_texel(point_numbers(position_ws, normal_ws),
                               texel_numbers(texel_ws, texel_normal_ws, softening));
  return kInvPi * sight.numerator * sight.inverse;
}

/// Softening of a texel that represents an area, per m^2: the squared radius of a disk of that
/// area.
const float kSofteningPerArea = kInvPi;

/// Texels are moved off their surface by this share of the square root of their area, so that
/// rounding cannot put a point of the same plane in their light.
const float kTexelOffset = 1e-3f;

LAMBENT_END
#endif
