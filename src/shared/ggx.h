// SPDX-License-Identifier: Apache-2.0
// The GGX lobe: its density, how it is drawn, and its directional albedo.
//
// Based on: Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough
// Surfaces", EGSR 2007; Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018.
#ifndef LAMBENT_SHARED_GGX_H
#define LAMBENT_SHARED_GGX_H

#include "shared/color.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// Narrower lobes are mirrors to float precision; alpha below this makes D overflow.
const float kMinGgxAlpha = 1e-3f;

/// Walter et al. 2007, Eq. 33: density of microfacet normals [1/sr].
LAMBENT_FN float ggx_distribution(float n_dot_h, float alpha) {
  float a2 = alpha * alpha;
  float d = n_dot_h * n_dot_h * (a2 - 1.0f) + 1.0f;
  return a2 * kInvPi / (d * d);
}

/// Smith's Lambda for GGX, from the cosine to the normal.
LAMBENT_FN float ggx_lambda(float cos_theta, float alpha) {
  float c2 = cos_theta * cos_theta;
  float tan2 = max(0.0f, 1.0f - c2) / max(c2, 1e-12f);
  return 0.5f * (sqrt(1.0f + alpha * alpha * tan2) - 1.0f);
}

/// A half vector seen from `to_viewer`. Heitz 2018, listing 1.
LAMBENT_FN vec3 sample_ggx_visible_normal(vec3 to_viewer, float alpha, vec2 u) {
  vec3 stretched = normalize(vec3(alpha * to_viewer.x, alpha * to_viewer.y, to_viewer.z));
  float lensq = stretched.x * stretched.x + stretched.y * stretched.y;
  vec3 t1 = lensq > 0.0f ? vec3(-stretched.y, stretched.x, 0.0f) * inversesqrt(lensq)
                         : vec3(1.0f, 0.0f, 0.0f);
  vec3 t2 = cross(stretched, t1);
  float radius = sqrt(u.x);
  float angle = kTwoPi * u.y;
  float p1 = radius * cos(angle);
  float p2 = radius * sin(angle);
  float s = 0.5f * (1.0f + stretched.z);
  p2 = (1.0f - s) * sqrt(max(0.0f, 1.0f - p1 * p1)) + s * p2;
  vec3 n = p1 * t1 + p2 * t2 + sqrt(max(0.0f, 1.0f - p1 * p1 - p2 * p2)) * stretched;
  return normalize(vec3(alpha * n.x, alpha * n.y, max(1e-6f, n.z)));
}

/// Density of the reflected direction that sample_ggx_visible_normal leads to [1/sr]. Heitz 2018,
/// Eq. 17.
LAMBENT_FN float pdf_ggx_reflection(vec3 to_viewer, vec3 to_light, float alpha) {
  if (to_viewer.z <= 0.0f || to_light.z <= 0.0f) return 0.0f;
  vec3 h = normalize(to_viewer + to_light);
  float g1 = 1.0f / (1.0f + ggx_lambda(to_viewer.z, alpha));
  return g1 * ggx_distribution(h.z, alpha) / (4.0f * to_viewer.z);
}

/// Value of a polynomial of the third degree.
LAMBENT_FN float cubic(vec4 c, float x) {
  return c.x + x * (c.y + x * (c.z + x * c.w));
}

// Share of light from a uniform sky that a GGX coat of reflectance 1 reflects once, its directional
// albedo: a polynomial in the roughness and in t = n_dot_v / (n_dot_v + alpha), fitted to integrals
// over visible normals (Heitz 2018) for roughness 0.03 to 1 and cosines 0.01 to 1, largest error
// 0.005. The share is less than 1 because light that a microfacet sends into another one is lost,
// as glTF's formulas and the reference have it.
LAMBENT_FN float ggx_albedo(float n_dot_v, float alpha) {
  float r = sqrt(alpha);
  float t = n_dot_v / (n_dot_v + alpha);
  float t0 = cubic(vec4(0.643397f, 1.81881f, -3.31849f, 2.58684f), r);
  float t1 = cubic(vec4(2.75546f, -11.322f, 14.341f, -8.10613f), r);
  float t2 = cubic(vec4(-8.31472f, 15.1522f, 20.1477f, -52.7755f), r);
  float t3 = cubic(vec4(9.90489f, -2.35144f, -70.7335f, 102.767f), r);
  float t4 = cubic(vec4(-4.00062f, -2.97278f, 36.5397f, -35.5672f), r);
  // The fourth powers of the roughness
  float r4 = alpha * alpha;
  t0 -= 0.752007f * r4;
  t1 -= 0.657047f * r4;
  t2 += 33.2661f * r4;
  t3 -= 51.8063f * r4;
  t4 += 13.6328f * r4;
  return clamp(t0 + t * (t1 + t * (t2 + t * (t3 + t * t4))), 0.0f, 1.0f);
}

/// Mean over that light of Schlick's (1 - v_dot_h)^5, fitted likewise: the largest error of the
/// Fresnel term of a coat of f0 = 0.04 is 4 % of it.
LAMBENT_FN float mean_schlick(float n_dot_v, float alpha) {
  float r = sqrt(alpha);
  float s = 1.0f - clamp(n_dot_v, 0.0f, 1.0f);
  float s2 = s * s;
  float s5 = s2 * s2 * s;
  float t = n_dot_v / (n_dot_v + alpha);
  float mean = cubic(vec4(0.000156805f, 0.00861857f, -0.0162152f, 0.00888212f), r);
  mean += cubic(vec4(0.0256367f, -0.381701f, 0.69692f, -0.347128f), r) * s;
  mean += cubic(vec4(-0.0850847f, 1.13927f, -1.73774f, 0.701174f), r) * s2;
  mean += cubic(vec4(1.10564f, -3.91654f, 4.57996f, -1.73939f), r) * s5;
  mean += cubic(vec4(-0.0137047f, 3.72759f, -9.52381f, 5.92496f), r) * s5 * t;
  return clamp(mean, 0.0f, 1.0f);
}

LAMBENT_END
#endif
