// SPDX-License-Identifier: Apache-2.0
// Light that was gathered for one normal, for another: how bumps are lit by light that was blurred
// over them.
#ifndef LAMBENT_SHARED_REORIENT_IRRADIANCE_H
#define LAMBENT_SHARED_REORIENT_IRRADIANCE_H

#include "shared/lang.h"

LAMBENT_BEGIN

// Irradiance is a sum over lights, w_i the unit way to one and L_i what it brings at best:
//
//     E(n) = SUM L_i max(0, n . w_i)
//
// As long as no light passes the horizon it is linear in the normal: E(m) = m . G, with G the sum
// of L_i w_i over what is above the horizon of n, and n . G = E(n). Lights do pass, and each that
// does adds to m . G, as E is convex: to second order, for a small tilt |m - n| = d,
//
//     E(m) = m . G + 1/2 d^2 H,   H = INT over the horizon of radiance
//
// H is not gathered. In an evenly lit half-space, where E = pi and G = pi n, half of the horizon of
// a tilted normal is lit, and E(m) = pi (1 + m . n) / 2 tells that H = E / 2. In light from aloft H
// is 0. Between both, h = H / E = 1/4 is off by no more than d^2 / 8 either way. With d^2 = 2 (1 -
// m . n),
//
//     | E(m) = m . R + h E(n),   R = G - h E(n) n |
//
// which is still linear in what is gathered, so means over pixels of E and R stay of that form, and
// changes nothing where all normals are the same. R, of luminance alone, is blurred with the light
// and tells at the end what that brings a pixel's own normal.
const float kHorizonLight = 0.25f;  // h

/// Least cosine between a normal and G: bounds what another normal may make of light that grazes.
const float kLeastDirectedCosine = 0.2f;

/// Share of the light whose ways must be known for them to stand for all: what texels of hardly any
/// light tell counts for nothing, and cannot overflow.
const float kLeastDirectedShare = 1e-6f;

/// R for a pixel of luminance `light`, from any vector along G: that is scaled, and tilted where it
/// would graze, to n . G = light. Without a direction light comes along the normal.
LAMBENT_FN vec3 reorientation(vec3 direction, vec3 normal, float light) {
  float across = dot(direction, normal);
  float bound = max(across, kLeastDirectedCosine * length(direction));
  float scale = bound > kLeastDirectedShare * light ? light / bound : 0.0f;
  return direction * scale + normal * ((1.0f - kHorizonLight) * light - across * scale);
}

/// Factor to light of that luminance, for a pixel of that normal; `means` is R.
LAMBENT_FN float reoriented_fraction(vec3 means, vec3 normal, float light) {
  return light > 0.0f ? max(0.0f, dot(means, normal) / light + kHorizonLight) : 0.0f;
}

LAMBENT_END
#endif
