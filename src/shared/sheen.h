// SPDX-License-Identifier: Apache-2.0
// The lobe of cloth: light that fibres scatter at grazing angles.
//
// Based on: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH courses 2017;
// Khronos Group, KHR_materials_sheen.
#ifndef LAMBENT_SHARED_SHEEN_H
#define LAMBENT_SHARED_SHEEN_H

#include "shared/ggx.h"

LAMBENT_BEGIN

// Narrower lobes would reflect more light than arrives at grazing angles. They are taken for lobes
// of this roughness that reflect as much light in all: see sheen_of_roughness().
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

// Share of light from a uniform sky that a white sheen reflects: integrals for roughness
// kMinSheenRoughness to 1 in equal steps (rows), and the square root of the cosine to the viewer
// from 0 to 1.
const int kSheenRows = 8;
const int kSheenColumns = 16;
// clang-format off
const float kSheenAlbedo[128] = {
    0.9379f, 1.0000f, 0.9435f, 0.8008f, 0.6523f, 0.5146f, 0.3931f, 0.2893f,
    0.2036f, 0.1355f, 0.0839f, 0.0472f, 0.0234f, 0.0094f, 0.0025f, 0.0001f,
    0.7667f, 0.8520f, 0.8111f, 0.7169f, 0.6137f, 0.5144f, 0.4227f, 0.3398f,
    0.2660f, 0.2014f, 0.1461f, 0.1002f, 0.0644f, 0.0370f, 0.0171f, 0.0041f,
    0.7139f, 0.8026f, 0.7783f, 0.7033f, 0.6184f, 0.5352f, 0.4570f, 0.3845f,
    0.3178f, 0.2568f, 0.2014f, 0.1521f, 0.1104f, 0.0749f, 0.0446f, 0.0192f,
    0.7183f, 0.8126f, 0.7966f, 0.7289f, 0.6508f, 0.5737f, 0.5009f, 0.4327f,
    0.3689f, 0.3093f, 0.2535f, 0.2020f, 0.1570f, 0.1167f, 0.0798f, 0.0457f,
    0.7535f, 0.8539f, 0.8416f, 0.7753f, 0.6981f, 0.6220f, 0.5502f, 0.4827f,
    0.4193f, 0.3592f, 0.3024f, 0.2490f, 0.2016f, 0.1583f, 0.1174f, 0.0784f,
    0.7999f, 0.9046f, 0.8930f, 0.8252f, 0.7464f, 0.6691f, 0.5963f, 0.5281f,
    0.4639f, 0.4029f, 0.3448f, 0.2899f, 0.2409f, 0.1959f, 0.1530f, 0.1118f,
    0.8341f, 0.9402f, 0.9283f, 0.8589f, 0.7789f, 0.7009f, 0.6277f, 0.5594f,
    0.4950f, 0.4340f, 0.3757f, 0.3205f, 0.2712f, 0.2259f, 0.1828f, 0.1413f,
    0.8287f, 0.9329f, 0.9218f, 0.8545f, 0.7770f, 0.7016f, 0.6312f, 0.5655f,
    0.5038f, 0.4452f, 0.3891f, 0.3359f, 0.2886f, 0.2451f, 0.2036f, 0.1638f};
// clang-format on

/// Directional albedo of a white sheen. Read linearly the table is within 0.003 of integrals for
/// cosines above 0.02; at the edge of the narrowest lobes it is 0.03 off.
LAMBENT_FN float sheen_albedo(float n_dot_v, float roughness) {
  float column = sqrt(clamp(n_dot_v, 0.0f, 1.0f)) * float(kSheenColumns - 1);
  float row = (clamp(roughness, kMinSheenRoughness, 1.0f) - kMinSheenRoughness) *
              (float(kSheenRows - 1) / (1.0f - kMinSheenRoughness));
  int i = min(int(row), kSheenRows - 2);
  int j = min(int(column), kSheenColumns - 2);
  int at = i * kSheenColumns + j;
  float across = column - float(j);
  float narrower = mix(kSheenAlbedo[at], kSheenAlbedo[at + 1], across);
  float wider = mix(kSheenAlbedo[at + kSheenColumns], kSheenAlbedo[at + kSheenColumns + 1], across);
  return mix(narrower, wider, row - float(i));
}

/// Its mean over light from a uniform sky: a polynomial fitted to the table within 0.0013.
LAMBENT_FN float mean_sheen_albedo(float roughness) {
  return cubic(vec4(0.038783f, -0.102069f, 0.88379f, -0.520938f), roughness);
}

LAMBENT_END
#endif
