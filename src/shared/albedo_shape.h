// SPDX-License-Identifier: Apache-2.0
// How the share of light that a surface reflects hangs on the angle at which it comes in.
//
// Hits of rays reflect evenly, by their albedo towards the viewer. A coat reflects more of light
// that grazes it than of light from above, and light sources have one direction, so that the
// albedo alone would take a twentieth too much of the sun's light on a glossy floor and too little
// of that on a wall. What is made of light that comes in at l and goes to v is
//   a(v) a(l) / mean of a,
// which is reciprocal, and whose albedo is right on both sides. The form is that of
// Based on: Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with
// Importance Sampling", Eurographics short papers, 2001, sec. 2.2.
#ifndef LAMBENT_SHARED_ALBEDO_SHAPE_H
#define LAMBENT_SHARED_ALBEDO_SHAPE_H

#include "shared/brdf.h"

LAMBENT_BEGIN

/// Means of ggx_albedo, and of ggx_albedo times mean_schlick, over light from a uniform sky:
/// polynomials in the roughness, fitted to integrals for 0.03 to 1. The largest errors are 0.004
/// and 0.001.
LAMBENT_FN float mean_ggx_albedo(float roughness) {
  return cubic(vec4(0.994986f, 0.0542969f, 0.0843987f, -1.89729f), roughness) +
         1.17697f * (roughness * roughness) * (roughness * roughness);
}
LAMBENT_FN float mean_ggx_schlick(float roughness) {
  return cubic(vec4(0.0479495f, 0.0461764f, -0.472023f, 0.663862f), roughness) -
         0.28416f * (roughness * roughness) * (roughness * roughness);
}

/// The mean of mean_base_schlick, likewise.
const float kMeanBaseSchlick = 0.00369f;

// Four numbers of 8 bits. That of f0 is a square root: 0.04 is told to 2 %.
const float kAlbedoShapeSteps = 255.0f;

/// A surface's luminances of base and f0, its f90 and its roughness. 0: it has no coat, and its
/// albedo is the same from everywhere.
LAMBENT_FN uint encode_albedo_shape(Reflectance surface) {
  if (surface.f90 <= 0.0f) return 0u;
  vec4 parts = vec4(luminance(surface.diffuse), sqrt(max(luminance(surface.f0), 0.0f)), surface.f90,
                    sqrt(surface.alpha));
  uvec4 steps = uvec4(clamp(parts, 0.0f, 1.0f) * kAlbedoShapeSteps + vec4(0.5f));
  return steps.x | (steps.y << 8u) | (steps.z << 16u) | (steps.w << 24u);
}

/// The albedo for light at this cosine to the normal, over its mean.
LAMBENT_FN float albedo_towards(uint shape, float n_dot_l) {
  if (shape == 0u) return 1.0f;
  vec4 parts =
      vec4(uvec4(shape & 255u, (shape >> 8u) & 255u, (shape >> 16u) & 255u, shape >> 24u)) *
      (1.0f / kAlbedoShapeSteps);
  float roughness = parts.w;
  float f0 = parts.y * parts.y;
  Reflectance gray = {vec3(parts.x), max(roughness * roughness, kMinGgxAlpha), vec3(f0), parts.z};
  float edge = parts.z - f0;
  float mean = parts.x * (1.0f - f0 - edge * kMeanBaseSchlick) + f0 * mean_ggx_albedo(roughness) +
               edge * mean_ggx_schlick(roughness);
  return mean > 0.0f ? effective_albedo(gray, n_dot_l).x / mean : 1.0f;
}

LAMBENT_END
#endif
