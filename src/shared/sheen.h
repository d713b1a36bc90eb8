// SPDX-License-Identifier: Apache-2.0
// The lobe of cloth: light that fibres scatter at grazing angles.
//
// Based on: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH courses 2017;
// Khronos Group, KHR_materials_sheen.
#ifndef LAMBENT_SHARED_SHEEN_H
#define LAMBENT_SHARED_SHEEN_H

#include "shared/ggx.h"

LAMBENT_BEGIN

// Least roughness of a sheen lobe: narrower ones would reflect more light than arrives at grazing
// angles. They are replaced by lobes of this roughness, scaled to the same mean albedo by
// narrow_sheen_factor().
const float kMinSheenRoughness = 0.25f;

/// Factor on the colour of a sheen that is narrower than kMinSheenRoughness: the ratio of the mean
/// albedos, a polynomial fitted to integrals for roughness 0.03 to 0.25 within 1 %; else 1.
LAMBENT_FN float narrow_sheen_factor(float roughness) {
  if (roughness >= kMinSheenRoughness) return 1.0f;
  return roughness * (3.4767f + 2.093f * roughness);
}

/// Density of the fibres' normals [1/sr]: Estevez and Kulla 2017, Eq. 2.
LAMBENT_FN float sheen_distribution(float n_dot_h, float alpha) {
  float squared_sine = max(1.0f - n_dot_h * n_dot_h, 0.0f);
  float exponent = 1.0f / alpha;
  return (2.0f + exponent) * pow(squared_sine, 0.5f * exponent) * (0.5f * kInvPi);
}

/// Estevez and Kulla 2017, Eq. 3 and table 1: the fitted exponent of Lambda.
LAMBENT_FN float sheen_lambda_exponent(float x, float alpha) {
  float t = (1.0f - alpha) * (1.0f - alpha);
  float a = mix(21.5473f, 25.3245f, t);
  float b = mix(3.82987f, 3.32435f, t);
  float c = mix(0.19823f, 0.16801f, t);
  float d = mix(-1.97760f, -1.27393f, t);
  float e = mix(-4.32054f, -4.85967f, t);
  return a / (1.0f + b * pow(x, c)) + d * x + e;
}

/// Smith's Lambda of the fibres, from the cosine to the normal.
LAMBENT_FN float sheen_lambda(float cos_theta, float alpha) {
  float x = clamp(cos_theta, 0.0f, 1.0f);
  if (x < 0.5f) return exp(sheen_lambda_exponent(x, alpha));
  return exp(2.0f * sheen_lambda_exponent(0.5f, alpha) - sheen_lambda_exponent(1.0f - x, alpha));
}

/// BRDF times cosine of a white sheen [1/sr], in the frame whose normal is +Z.
LAMBENT_FN float sheen_lobe(vec3 to_viewer, vec3 to_light, float roughness) {
  if (to_viewer.z <= 0.0f || to_light.z <= 0.0f) return 0.0f;
  float alpha = roughness * roughness;
  float n_dot_h = normalize(to_viewer + to_light).z;
  float shadowed = 1.0f + sheen_lambda(to_viewer.z, alpha) + sheen_lambda(to_light.z, alpha);
  return sheen_distribution(n_dot_h, alpha) / (4.0f * to_viewer.z * shadowed);
}

/// Directional albedo of a white sheen: a polynomial in the roughness and in the square root of the
/// cosine, both shifted to [-1, 1], fitted to integrals for roughness kMinSheenRoughness to 1.
/// Within 0.0025 for cosines above 0.03; at grazing angles of the narrowest lobes the error is
/// 0.016. Not a table: many shaders contain this function, and devices keep tables in slow memory.
LAMBENT_FN float sheen_albedo(float n_dot_v, float roughness) {
  float t = 2.0f * sqrt(clamp(n_dot_v, 0.0f, 1.0f)) - 1.0f;
  float within = (clamp(roughness, kMinSheenRoughness, 1.0f) - kMinSheenRoughness) /
                 (1.0f - kMinSheenRoughness);
  float r = 2.0f * within - 1.0f;
  vec4 low = vec4(quartic(vec4(0.42627f, 0.17295f, -0.00411f, -0.02894f), -0.03188f, r),
                  quartic(vec4(-0.48366f, 0.00604f, -0.08738f, 0.08548f), 0.01024f, r),
                  quartic(vec4(0.06358f, -0.02819f, 0.04775f, -0.16723f), 0.13435f, r),
                  quartic(vec4(0.06698f, -0.05585f, 0.04093f, 0.03567f), -0.05998f, r));
  vec4 high = vec4(quartic(vec4(0.28387f, 0.02663f, 0.09053f, 0.02306f), -0.09939f, r),
                   quartic(vec4(-0.2478f, 0.01648f, -0.04803f, 0.01935f), 0.03686f, r),
                   quartic(vec4(-0.4114f, -0.04765f, -0.0861f, 0.06174f), 0.03291f, r),
                   quartic(vec4(0.36466f, 0.0226f, 0.07448f, -0.0617f), -0.03077f, r));
  float t2 = t * t;
  return clamp(cubic(low, t) + t2 * t2 * cubic(high, t), 0.0f, 1.0f);
}

/// Mean of sheen_albedo over light from a uniform sky: a polynomial fitted to its means within
/// 0.002.
LAMBENT_FN float mean_sheen_albedo(float roughness) {
  return cubic(vec4(0.0405245f, -0.114617f, 0.90714f, -0.532938f), roughness);
}

LAMBENT_END
#endif
