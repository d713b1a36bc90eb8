// SPDX-License-Identifier: Apache-2.0
// How the share of light that a surface reflects depends on the light's direction.
//
// Hits of rays reflect light by their directional albedo a(v) towards the viewer, which is exact
// for light from a uniform sky. Light of a source comes from one direction: a(v) alone reflects too
// much of a high sun on a glossy floor, too little of it on a wall, and has no highlight.
// reflected_cosine() corrects this with the surface's BRDF. Surfaces with layers have too many
// parameters to store; their reflection is approximated by a(v) a(l) / (mean of a), which is
// reciprocal and reflects the right share of light from any direction.
//
// Based on: Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with
// Importance Sampling", Eurographics short papers, 2001, sec. 2.2.
#ifndef LAMBENT_SHARED_ALBEDO_SHAPE_H
#define LAMBENT_SHARED_ALBEDO_SHAPE_H

#include "shared/brdf.h"

LAMBENT_BEGIN

/// Means of ggx_albedo, and of ggx_albedo times mean_schlick, over light from a uniform sky:
/// polynomials in the roughness, fitted to integrals of these for 33 roughnesses from 0.03 to 1.
/// The largest errors are 0.0012 and 0.0008.
LAMBENT_FN float mean_ggx_albedo(float roughness) {
  return quintic(vec4(1.00407f, -0.120706f, 1.02226f, -3.95196f), vec2(3.19254f, -0.736697f),
                 roughness);
}
LAMBENT_FN float mean_ggx_schlick(float roughness) {
  return quintic(vec4(0.044665f, 0.086376f, -0.665178f, 1.12345f), vec2(-0.796749f, 0.210187f),
                 roughness);
}

/// The mean of mean_base_schlick over the same light.
const float kMeanBaseSchlick = 0.00369f;

// The shape is four numbers of 8 bits. f0 is stored as its square root, which represents 0.04 to
// within 2 %.
const float kAlbedoShapeSteps = 255.0f;

// For surfaces with layers, the highest of the four bytes is 0, which no roughness encodes to. The
// shape is then 1 + k1 (s - 1/3) + k5 (s^5 - 1/21) with s = 1 - n_dot_l, whose mean is 1, and k1
// and k5 have 12 bits each.
const float kLayeredShapeSteps = 4095.0f;
const float kLeastShapeFactor = -8.0f;
const float kShapeFactorRange = 32.0f;
// Means of s and s^5 over light from a uniform sky.
const float kMeanFirst = 1.0f / 3.0f;
const float kMeanFifth = 1.0f / 21.0f;

// Nodes and weights of Gauss-Legendre quadrature over the cosine.
const int kCosineNodes = 5;
const float kCosinePoints[kCosineNodes] = {0.0469101f, 0.2307653f, 0.5f, 0.7692347f, 0.9530899f};
const float kCosineWeights[kCosineNodes] = {0.1184634f, 0.2393143f, 0.2844444f, 0.2393143f,
                                            0.1184634f};

/// The mean of effective_albedo over light from a uniform sky: the share of the light that arrives
/// which the surface reflects to all sides together.
LAMBENT_FN vec3 mean_albedo(Reflectance surface) {
  if (has_layers(surface.layers)) {
    vec3 mean = vec3(0.0f);
    for (int i = 0; i < kCosineNodes; ++i) {
      surface.layers.clearcoat_cosine = kCosinePoints[i];
      mean += (2.0f * kCosineWeights[i] * kCosinePoints[i]) *
              effective_albedo(surface, kCosinePoints[i]);
    }
    return mean;
  }
  if (surface.f90 <= 0.0f) return surface.diffuse;
  float roughness = sqrt(surface.alpha);
  vec3 edge = vec3(surface.f90) - surface.f0;
  return surface.diffuse * (vec3(1.0f) - surface.f0 - edge * kMeanBaseSchlick) +
         surface.f0 * mean_ggx_albedo(roughness) + edge * mean_ggx_schlick(roughness);
}

// Keeps the division by the mean albedo finite for black surfaces.
const float kLeastMeanAlbedo = 1e-6f;

/// effective_albedo(), scaled down where its mean would exceed `max_mean`. On average, the
/// mean alone decides whether light dies out from bounce to bounce. Towards grazing directions a
/// smooth coat over a bright base has an albedo far above 1 in glTF's formulas (1.5 at a cosine of
/// 0.1), which other directions make up for: a bound on each direction would lose that light.
LAMBENT_FN vec3 bounded_albedo(Reflectance surface, float n_dot_v, float max_mean) {
  vec3 scale = min(vec3(1.0f), vec3(max_mean) / max(mean_albedo(surface), vec3(kLeastMeanAlbedo)));
  return effective_albedo(surface, n_dot_v) * scale;
}

/// The factors k1 and k5 that best fit the albedo of a gray surface with layers.
LAMBENT_FN vec2 layered_shape_factors(Reflectance gray) {
  float albedos[5];
  float mean = 0.0f;
  for (int i = 0; i < kCosineNodes; ++i) {
    gray.layers.clearcoat_cosine = kCosinePoints[i];
    albedos[i] = effective_albedo(gray, kCosinePoints[i]).x;
    mean += 2.0f * kCosineWeights[i] * kCosinePoints[i] * albedos[i];
  }
  if (mean <= 0.0f) return vec2(0.0f);
  // Least squares over light from a uniform sky
  vec2 projected = vec2(0.0f);
  vec3 products = vec3(0.0f);
  for (int i = 0; i < kCosineNodes; ++i) {
    float s = 1.0f - kCosinePoints[i];
    vec2 basis = vec2(s - kMeanFirst, s * s * s * s * s - kMeanFifth);
    float weight = kCosineWeights[i] * kCosinePoints[i];
    projected += basis * (weight * (albedos[i] / mean - 1.0f));
    products += weight * vec3(basis.x * basis.x, basis.x * basis.y, basis.y * basis.y);
  }
  float determinant = products.x * products.z - products.y * products.y;
  return vec2(projected.x * products.z - projected.y * products.y,
              projected.y * products.x - projected.x * products.y) /
         determinant;
}

LAMBENT_FN uint encode_layered_shape(Reflectance surface) {
  Reflectance gray = surface;
  gray.diffuse = vec3(luminance(surface.diffuse));
  gray.f0 = vec3(luminance(surface.f0));
  gray.layers.sheen = vec3(luminance(surface.layers.sheen));
  vec2 factors = (layered_shape_factors(gray) - vec2(kLeastShapeFactor)) / kShapeFactorRange;
  uvec2 steps = uvec2(clamp(factors, 0.0f, 1.0f) * kLayeredShapeSteps + vec2(0.5f));
  return steps.x | (steps.y << 12u);
}

LAMBENT_FN float layered_albedo_towards(uint shape, float n_dot_l) {
  vec2 factors =
      vec2(uvec2(shape & 4095u, shape >> 12u)) * (kShapeFactorRange / kLayeredShapeSteps) +
      vec2(kLeastShapeFactor);
  float s = 1.0f - clamp(n_dot_l, 0.0f, 1.0f);
  float s2 = s * s;
  return max(1.0f + factors.x * (s - kMeanFirst) + factors.y * (s2 * s2 * s - kMeanFifth), 0.0f);
}

/// Packs the luminances of a surface's base and f0, its f90 and its roughness, or for layers k1 and
/// k5. 0 for a Lambert surface, whose albedo is the same for all directions.
LAMBENT_FN uint encode_albedo_shape(Reflectance surface) {
  if (has_layers(surface.layers)) return encode_layered_shape(surface);
  if (surface.f90 <= 0.0f) return 0u;
  vec4 parts = vec4(luminance(surface.diffuse), sqrt(max(luminance(surface.f0), 0.0f)), surface.f90,
                    sqrt(surface.alpha));
  uvec4 steps = uvec4(clamp(parts, 0.0f, 1.0f) * kAlbedoShapeSteps + vec4(0.5f));
  return steps.x | (steps.y << 8u) | (steps.z << 16u) | (steps.w << 24u);
}

/// The gray surface that a shape encodes; the shape must not be 0 or that of layers.
LAMBENT_FN Reflectance gray_of_shape(uint shape) {
  vec4 parts =
      vec4(uvec4(shape & 255u, (shape >> 8u) & 255u, (shape >> 16u) & 255u, shape >> 24u)) *
      (1.0f / kAlbedoShapeSteps);
  Reflectance gray = {vec3(parts.x),
                      max(parts.w * parts.w, kMinGgxAlpha),
                      vec3(parts.y * parts.y),
                      parts.z,
                      no_layers(),
                      1.0f};
  return gray;
}

/// The directional albedo for light at this cosine to the normal, divided by its mean.
LAMBENT_FN float albedo_towards(uint shape, float n_dot_l) {
  if (shape == 0u) return 1.0f;
  if ((shape >> 24u) == 0u) return layered_albedo_towards(shape, n_dot_l);
  Reflectance gray = gray_of_shape(shape);
  float mean = mean_albedo(gray).x;
  return mean > 0.0f ? effective_albedo(gray, n_dot_l).x / mean : 1.0f;
}

/// Least GGX width with which hits of rays reflect light of sources: few rays hit a narrower
/// highlight, and each of these would be a firefly. Widening does not change the albedo. Kaplanyan
/// and Dachsbacher, "Path Space Regularization for Holistic and Robust Light Transport", Computer
/// Graphics Forum 32(2), 2013.
const float kMinAlphaOfHits = 0.25f;

/// The part of reflected_cosine() that depends on the viewer, but not on the light.
struct SeenShape {
  uint shape;        ///< See encode_albedo_shape().
  float diffuse;     ///< Albedo of the base.
  float f0;          ///< Specular reflectance at normal incidence.
  float f90;         ///< Specular reflectance at grazing incidence.
  float alpha;       ///< GGX width, at least kMinAlphaOfHits.
  float lambda;      ///< ggx_lambda() of the viewer.
  float lobe_scale;  ///< Albedo of the coat over that of its widened lobe.
  float albedo;      ///< Directional albedo; 0 where albedo_towards() answers instead.
};

/// Finds what a viewer sees of an encoded shape; directions are unit vectors.
LAMBENT_FN SeenShape seen_shape(uint shape, vec3 normal, vec3 to_viewer) {
  SeenShape seen = {shape, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  float n_dot_v = dot(normal, to_viewer);
  if (shape == 0u || (shape >> 24u) == 0u || n_dot_v <= 0.0f) return seen;
  Reflectance gray = gray_of_shape(shape);
  float base = base_albedo(gray, n_dot_v).x;
  float coat = specular_albedo(gray, n_dot_v).x;
  if (base + coat <= 0.0f) {
    seen.shape = 0u;
    return seen;
  }
  gray.alpha = max(gray.alpha, kMinAlphaOfHits);
  seen.diffuse = gray.diffuse.x;
  seen.f0 = gray.f0.x;
  seen.f90 = gray.f90;
  seen.alpha = gray.alpha;
  seen.lambda = ggx_lambda(n_dot_v, gray.alpha);
  float widened = specular_albedo(gray, n_dot_v).x;
  seen.lobe_scale = widened > 0.0f ? coat / widened : 0.0f;
  seen.albedo = base + coat;
  return seen;
}

// The cosine to which smith_lambda() clamps: a coat's lobe is divided by no smaller one.
const float kLeastViewCosine = 1e-6f;

/// Pi times the BRDF times a light's cosine, over the directional albedo towards the viewer. Over a
/// uniform sky its mean is that of the cosine. `received`: the cosine for the base, see
/// bumpy_cosine(), and for surfaces whose albedo_towards() answers. Other coats are as rough as
/// their bumps: they have the cosine to their mean normal, and show no light below its horizon.
/// `seen` is that of seen_shape() for this normal and viewer.
LAMBENT_FN float reflected_cosine(SeenShape seen, vec3 normal, vec3 to_viewer, vec3 to_light,
                                  float received) {
  float n_dot_l = dot(normal, to_light);
  if (seen.albedo <= 0.0f) return received * albedo_towards(seen.shape, n_dot_l);
  vec3 sum = to_viewer + to_light;
  vec3 h = sum / max(length(sum), 1e-6f);
  float f = seen.f0 + (seen.f90 - seen.f0) * schlick_power(dot(to_viewer, h));
  float base = (1.0f - f) * seen.diffuse * received;
  if (n_dot_l <= 0.0f) return base / seen.albedo;
  float d = ggx_distribution(dot(normal, h), seen.alpha);
  float g = 1.0f / (1.0f + seen.lambda + ggx_lambda(n_dot_l, seen.alpha));
  float coat = kPi * f * d * g / (4.0f * max(dot(normal, to_viewer), kLeastViewCosine));
  return (base + coat * seen.lobe_scale) / seen.albedo;
}

LAMBENT_END
#endif
