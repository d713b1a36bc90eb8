// SPDX-License-Identifier: Apache-2.0
// The GGX lobe: its density, its sampling, and its directional albedo.
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

#define Real float
#define Real3 vec3
#define LAMBENT_REAL_FN LAMBENT_FN
#include "shared/microfacet.inl.h"
#undef Real
#undef Real3
#undef LAMBENT_REAL_FN

/// Smith's Lambda for GGX, from the cosine to the normal.
LAMBENT_FN float ggx_lambda(float cos_theta, float alpha) {
  return smith_lambda(cos_theta, alpha * alpha);
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

/// Values of polynomials of the fourth and the fifth degree.
LAMBENT_FN float quartic(vec4 low, float high, float x) {
  float x2 = x * x;
  return cubic(low, x) + x2 * x2 * high;
}
LAMBENT_FN float quintic(vec4 low, vec2 high, float x) {
  float x2 = x * x;
  return cubic(low, x) + x2 * x2 * (high.x + x * high.y);
}

// Single-scattering directional albedo of a GGX coat of reflectance 1: a polynomial in the
// roughness and in t = n_dot_v / (n_dot_v + alpha), fitted to integrals over visible normals (Heitz
// 2018) for roughness 0.03 to 1 and cosines 0.005 to 1, with a largest relative error of 0.3 %. It
// is less than 1 because light that a microfacet reflects into another one is lost, as in glTF's
// formulas and in the reference path tracer.
LAMBENT_FN float ggx_albedo(float n_dot_v, float alpha) {
  float r = sqrt(alpha);
  float t = n_dot_v / (n_dot_v + alpha);
  float t0 = quintic(vec4(0.79848f, 1.46624f, -3.96727f, 5.09093f), vec2(-3.15414f, 0.752649f), r);
  float t1 = quintic(vec4(2.0446f, -14.9718f, 34.777f, -35.1061f), vec2(9.24546f, 0.539641f), r);
  float t2 = quintic(vec4(-9.2465f, 57.4929f, -110.538f, 68.1544f), vec2(20.9701f, -12.8429f), r);
  float t3 = quintic(vec4(15.9551f, -99.4171f, 126.166f, 81.7032f), vec2(-227.102f, 58.1392f), r);
  float t4 = quintic(vec4(-11.2313f, 78.9224f, -34.1837f, -242.325f), vec2(280.685f, 2.05084f), r);
  float t5 = quintic(vec4(2.68674f, -23.8323f, -7.87703f, 96.4426f), vec2(-20.364f, -94.8336f), r);
  return clamp(quintic(vec4(t0, t1, t2, t3), vec2(t4, t5), t), 0.0f, 1.0f);
}

/// Mean of Schlick's (1 - v_dot_h)^5 over the reflected light of a uniform sky: a polynomial in the
/// roughness, in s = 1 - n_dot_v and in t = n_dot_v / (n_dot_v + 2 alpha), fitted in the same way.
/// The largest relative error of the albedo of a coat with f0 = 0.04 is 0.7 %.
LAMBENT_FN float mean_schlick(float n_dot_v, float alpha) {
  float r = sqrt(alpha);
  float s = 1.0f - clamp(n_dot_v, 0.0f, 1.0f);
  float s2 = s * s;
  float t = n_dot_v / (n_dot_v + 2.0f * alpha);
  float of_s2 = quartic(vec4(-0.645416f, 1.6812f, 1.40505f, -4.04315f), 2.08932f, r);
  of_s2 += t * quartic(vec4(-0.676752f, 12.0614f, -34.9115f, 33.441f), -13.3036f, r);
  of_s2 += t * t * quartic(vec4(1.30589f, -13.0932f, 31.1154f, -32.6952f), 19.7224f, r);
  float of_s5 = quartic(vec4(1.82227f, -5.36455f, 3.16179f, 1.54286f), -1.60283f, r);
  of_s5 += t * quartic(vec4(0.180211f, -2.72908f, 7.11986f, -4.51009f), 0.435808f, r);
  of_s5 += t * t * quartic(vec4(-0.980453f, 7.68897f, -1.33752f, -28.0531f), 23.9323f, r);
  return clamp(s2 * (of_s2 + s2 * s * of_s5), 0.0f, 1.0f);
}

LAMBENT_END
#endif
