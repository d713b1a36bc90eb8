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

// Directional albedo of a white sheen: integrals for roughness kMinSheenRoughness to 1 in equal
// steps (rows), and the square root of the cosine to the viewer from 0 to 1 (columns).
const int kSheenRows = 12;
const int kSheenColumns = 16;
// clang-format off
const float kSheenAlbedo[192] = {
    0.9379f, 1.0000f, 0.9435f, 0.8008f, 0.6523f, 0.5146f, 0.3931f, 0.2893f,
    0.2036f, 0.1355f, 0.0839f, 0.0472f, 0.0234f, 0.0094f, 0.0025f, 0.0001f,
    0.8095f, 0.8946f, 0.8434f, 0.7368f, 0.6218f, 0.5122f, 0.4122f, 0.3232f,
    0.2456f, 0.1794f, 0.1245f, 0.0809f, 0.0485f, 0.0253f, 0.0101f, 0.0016f,
    0.7443f, 0.8302f, 0.7951f, 0.7079f, 0.6114f, 0.5179f, 0.4311f, 0.3519f,
    0.2805f, 0.2171f, 0.1616f, 0.1145f, 0.0767f, 0.0467f, 0.0235f, 0.0069f,
    0.7159f, 0.8040f, 0.7787f, 0.7026f, 0.6166f, 0.5324f, 0.4534f, 0.3804f,
    0.3132f, 0.2519f, 0.1965f, 0.1474f, 0.1061f, 0.0712f, 0.0417f, 0.0173f,
    0.7112f, 0.8028f, 0.7838f, 0.7137f, 0.6335f, 0.5544f, 0.4799f, 0.4103f,
    0.3457f, 0.2856f, 0.2301f, 0.1796f, 0.1359f, 0.0975f, 0.0632f, 0.0325f,
    0.7229f, 0.8184f, 0.8034f, 0.7363f, 0.6587f, 0.5821f, 0.5096f, 0.4418f,
    0.3782f, 0.3186f, 0.2627f, 0.2109f, 0.1654f, 0.1244f, 0.0866f, 0.0513f,
    0.7457f, 0.8450f, 0.8323f, 0.7661f, 0.6890f, 0.6130f, 0.5411f, 0.4737f,
    0.4104f, 0.3505f, 0.2938f, 0.2408f, 0.1938f, 0.1509f, 0.1106f, 0.0723f,
    0.7745f, 0.8771f, 0.8655f, 0.7986f, 0.7209f, 0.6444f, 0.5721f, 0.5044f,
    0.4407f, 0.3802f, 0.3227f, 0.2686f, 0.2203f, 0.1761f, 0.1341f, 0.0938f,
    0.8039f, 0.9088f, 0.8973f, 0.8292f, 0.7503f, 0.6728f, 0.5999f, 0.5317f,
    0.4674f, 0.4063f, 0.3481f, 0.2932f, 0.2441f, 0.1990f, 0.1560f, 0.1147f,
    0.8275f, 0.9336f, 0.9217f, 0.8526f, 0.7727f, 0.6946f, 0.6213f, 0.5528f,
    0.4884f, 0.4271f, 0.3687f, 0.3134f, 0.2641f, 0.2187f, 0.1754f, 0.1338f,
    0.8382f, 0.9440f, 0.9321f, 0.8629f, 0.7832f, 0.7056f, 0.6329f, 0.5651f,
    0.5013f, 0.4408f, 0.3829f, 0.3281f, 0.2792f, 0.2343f, 0.1915f, 0.1504f,
    0.8287f, 0.9329f, 0.9218f, 0.8545f, 0.7770f, 0.7016f, 0.6312f, 0.5655f,
    0.5038f, 0.4452f, 0.3891f, 0.3359f, 0.2886f, 0.2451f, 0.2036f, 0.1638f};
// clang-format on

/// Directional albedo of a white sheen. Bilinear interpolation of the table is within 0.005 of the
/// integrals for cosines above 0.03; at grazing angles of the narrowest lobes the error is 0.03.
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

/// Mean of sheen_albedo over light from a uniform sky: a polynomial fitted to the table within
/// 0.0013.
LAMBENT_FN float mean_sheen_albedo(float roughness) {
  return cubic(vec4(0.0405245f, -0.114617f, 0.90714f, -0.532938f), roughness);
}

LAMBENT_END
#endif
