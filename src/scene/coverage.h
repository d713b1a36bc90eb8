// SPDX-License-Identifier: Apache-2.0
// Which rays see-through triangles stop.
#ifndef LAMBENT_SCENE_COVERAGE_H
#define LAMBENT_SCENE_COVERAGE_H

#include "shared/random.h"

LAMBENT_BEGIN

/// AlphaMode of scene.h, by its numbers.
const uint kAlphaOpaque = 0u;
const uint kAlphaMask = 1u;
const uint kAlphaBlend = 2u;

/// Keeps the hits of neighbouring triangles apart: 2^32 over the golden ratio.
const uint kTriangleHashStep = 0x9E3779B9u;

/// Keeps what decides over glass apart from what decides over coverage.
const uint kGlassSalt = 0x85EBCA6Bu;

/// A random number in [0, 1) that belongs to this hit alone, so that coverage is decided without
/// state.
LAMBENT_FN float uniform_of_hit(vec2 barycentrics, float distance, uint triangle) {
  uvec3 mixed = hash_pcg3d(uvec3(floatBitsToUint(barycentrics.x) ^ (triangle * kTriangleHashStep),
                                 floatBitsToUint(barycentrics.y), floatBitsToUint(distance)));
  return uniform_from_bits(mixed.x);
}

/// Probability that a ray which meets coverage `alpha` is stopped.
LAMBENT_FN float stopping_probability(uint alpha_mode, float alpha_cutoff, float alpha) {
  if (alpha_mode == kAlphaMask) return alpha >= alpha_cutoff ? 1.0f : 0.0f;
  if (alpha_mode == kAlphaBlend) return clamp(alpha, 0.0f, 1.0f);
  return 1.0f;
}

/// Whether coverage `alpha` stops the ray of this very hit.
LAMBENT_FN bool stops_ray(uint alpha_mode, float alpha_cutoff, float alpha, vec2 barycentrics,
                          float distance, uint triangle) {
  if (alpha_mode == kAlphaMask) return alpha >= alpha_cutoff;
  if (alpha_mode == kAlphaBlend) return alpha > uniform_of_hit(barycentrics, distance, triangle);
  return true;
}

LAMBENT_END
#endif
