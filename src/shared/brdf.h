// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, Appendix B, "BRDF Implementation"; Heitz,
// "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018.
#ifndef LAMBENT_SHARED_BRDF_H
#define LAMBENT_SHARED_BRDF_H

#include "shared/color.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// How a surface point reflects: a Lambert base under a GGX coat that shares one Fresnel term.
struct Reflectance {
  vec3 diffuse;  ///< Albedo of the base, 0 to 1: base color * (1 - metallic).
  float alpha;   ///< GGX width, roughness squared; at least kMinGgxAlpha.
  vec3 f0;       ///< Specular reflectance at normal incidence.
  float f90;     ///< At grazing incidence; 0 with f0 = 0 makes an exact Lambert surface.
};

/// Narrower lobes are mirrors to float precision; alpha below this makes D overflow.
const float kMinGgxAlpha = 1e-3f;

/// Schlick 1994: the share reflected by the coat at the angle between direction and half vector.
LAMBENT_FN vec3 fresnel(Reflectance surface, float v_dot_h) {
  float m = clamp(1.0f - v_dot_h, 0.0f, 1.0f);
  float m5 = m * m * m * m * m;
  return surface.f0 + (vec3(surface.f90) - surface.f0) * m5;
}

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

/// The two parts of the reflection function times cos(theta_l).
struct ReflectedPair {
  vec3 diffuse;
  vec3 specular;
};

/// BRDF times cosine, for unit directions to the viewer and to the light in the frame whose normal
/// is +Z. Zero where either is below the surface.
LAMBENT_FN ReflectedPair evaluate_reflectance(Reflectance surface, vec3 to_viewer, vec3 to_light) {
  ReflectedPair result = {vec3(0.0f), vec3(0.0f)};
  float n_dot_v = to_viewer.z;
  float n_dot_l = to_light.z;
  if (n_dot_v <= 0.0f || n_dot_l <= 0.0f) return result;
  if (surface.f90 <= 0.0f) {
    result.diffuse = surface.diffuse * (kInvPi * n_dot_l);
    return result;
  }
  vec3 h = normalize(to_viewer + to_light);
  vec3 f = fresnel(surface, dot(to_viewer, h));
  float d = ggx_distribution(h.z, surface.alpha);
  float g = 1.0f / (1.0f + ggx_lambda(n_dot_v, surface.alpha) + ggx_lambda(n_dot_l, surface.alpha));
  result.diffuse = (vec3(1.0f) - f) * surface.diffuse * (kInvPi * n_dot_l);
  result.specular = f * (d * g / (4.0f * n_dot_v));
  return result;
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

/// Share of light from a uniform sky that the coat reflects: its directional albedo.
LAMBENT_FN vec3 specular_albedo(Reflectance surface, float n_dot_v) {
  float cosine = max(n_dot_v, 0.0f);
  vec3 f = surface.f0 + (vec3(surface.f90) - surface.f0) * mean_schlick(cosine, surface.alpha);
  return f * ggx_albedo(cosine, surface.alpha);
}

/// Mean of Schlick's (1 - v_dot_h)^5 over light from a uniform sky, in proportion to the cosine to
/// the normal: a polynomial fitted to integrals for 25 cosines, largest error 0.0001. It does not
/// depend on the roughness, since the base has no microfacets.
LAMBENT_FN float mean_base_schlick(float n_dot_v) {
  float s = 1.0f - clamp(n_dot_v, 0.0f, 1.0f);
  return s * cubic(vec4(0.00431124f, -0.00181278f, 0.0255616f, 0.0f), s);
}

/// Share of light from a uniform sky that the base reflects through the coat: the base's
/// directional albedo.
LAMBENT_FN vec3 base_albedo(Reflectance surface, float n_dot_v) {
  vec3 reflected = surface.f0 + (vec3(surface.f90) - surface.f0) * mean_base_schlick(n_dot_v);
  return surface.diffuse * (vec3(1.0f) - reflected);
}

/// The share of light that a surface sends back, as if it did so evenly: its Lambert base under the
/// coat, and the coat's own directional albedo, so that metals pass light on, too.
LAMBENT_FN vec3 effective_albedo(Reflectance surface, float n_dot_v) {
  if (surface.f90 <= 0.0f) return surface.diffuse;
  return base_albedo(surface, n_dot_v) + specular_albedo(surface, n_dot_v);
}

/// Probability with which importance sampling should pick the specular lobe.
LAMBENT_FN float specular_probability(Reflectance surface, float n_dot_v) {
  if (surface.f90 <= 0.0f) return 0.0f;
  float specular = luminance(specular_albedo(surface, n_dot_v));
  float diffuse = luminance(surface.diffuse);
  return clamp(specular / max(specular + diffuse, 1e-6f), 0.1f, 1.0f);
}

/// A direction to reflect from: of the specular lobe with probability `specular_share` (u.z
/// decides), else of the cosine lobe. May point below the surface, where the density is 0.
LAMBENT_FN vec3 sample_lobes(Reflectance surface, vec3 to_viewer, float specular_share, vec3 u) {
  if (u.z >= specular_share) return sample_cosine_hemisphere(vec2(u.x, u.y));
  vec3 h = sample_ggx_visible_normal(to_viewer, surface.alpha, vec2(u.x, u.y));
  return reflect(-to_viewer, h);
}

/// Density of sample_lobes [1/sr].
LAMBENT_FN float pdf_lobes(Reflectance surface, vec3 to_viewer, float specular_share,
                           vec3 to_light) {
  float pdf = (1.0f - specular_share) * pdf_cosine_hemisphere(to_light.z);
  if (specular_share > 0.0f) {
    pdf += specular_share * pdf_ggx_reflection(to_viewer, to_light, surface.alpha);
  }
  return pdf;
}

/// A direction to reflect from, drawn from the mix of both lobes that suits the surface.
LAMBENT_FN vec3 sample_reflectance(Reflectance surface, vec3 to_viewer, vec3 u) {
  return sample_lobes(surface, to_viewer, specular_probability(surface, to_viewer.z), u);
}

/// Density of sample_reflectance [1/sr].
LAMBENT_FN float pdf_reflectance(Reflectance surface, vec3 to_viewer, vec3 to_light) {
  return pdf_lobes(surface, to_viewer, specular_probability(surface, to_viewer.z), to_light);
}

LAMBENT_END
#endif
