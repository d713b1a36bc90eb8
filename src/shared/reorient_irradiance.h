// SPDX-License-Identifier: Apache-2.0
// Converts irradiance that was gathered for one normal to another normal, so that light can be
// blurred over bumps without losing them.
#ifndef LAMBENT_SHARED_REORIENT_IRRADIANCE_H
#define LAMBENT_SHARED_REORIENT_IRRADIANCE_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Irradiance is a sum over lights, where w_i is the unit direction to light i, and L_i its
// irradiance at perpendicular incidence:
//
//     E(n) = SUM L_i max(0, n . w_i)
//
// As long as no light crosses the horizon, it is linear in the normal: E(m) = m . G, where G is the
// sum of L_i w_i over the lights above the horizon of n, and n . G = E(n). Each light that does
// cross it adds to m . G, since E is convex: to second order, for a small tilt |m - n| = d,
//
//     E(m) = m . G + 1/2 d^2 H,   H = INT over the horizon of radiance
//
// H is not gathered. In a uniformly lit half-space, where E = pi and G = pi n, half of the horizon
// of a tilted normal is lit, and E(m) = pi (1 + m . n) / 2 gives H = E / 2. For light along the
// normal, H is 0. The mean of both, h = H / E = 1/4, has an error of at most d^2 / 8 either way.
// With d^2 = 2 (1 - m . n),
//
//     | E(m) = m . R + h E(n),   R = G - h E(n) n |
//
// which is still linear in the gathered quantities, so that means of E and R over pixels keep this
// form, and which changes nothing where all normals are the same. R, of luminance alone, is blurred
// with the light, and finally yields the irradiance for a pixel's own normal.
const float kHorizonLight = 0.25f;  // h

/// Least cosine between a normal and G: bounds the factor by which grazing light can grow for
/// another normal.
const float kLeastDirectedCosine = 0.2f;

/// Least ratio of the directional part to the luminance for which the direction is used. Below it,
/// the direction is unreliable, and the division could overflow.
const float kLeastDirectedShare = 1e-6f;

#define Real float
#define LAMBENT_REAL_FN LAMBENT_FN
#include "shared/relit_blur.inl.h"
#undef Real
#undef LAMBENT_REAL_FN

/// R for a pixel of luminance `light`, from any vector along G. The vector is scaled so that n . G
/// = light, and tilted where it grazes. Without a direction, light comes along the normal.
LAMBENT_FN vec3 reorientation(vec3 direction, vec3 normal, float light) {
  float across = dot(direction, normal);
  float scale = direction_scale(light, across, length(direction));
  return direction * scale + normal * reorientation_along_normal(light, across, scale);
}

/// Factor on light of this luminance, for a pixel with this normal; `means` is the mean of R.
LAMBENT_FN float reoriented_fraction(vec3 means, vec3 normal, float light) {
  return reoriented_share(dot(means, normal), light);
}

LAMBENT_END
#endif
