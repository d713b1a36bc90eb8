// SPDX-License-Identifier: Apache-2.0
// Which rays see-through triangles stop.
#ifndef LAMBENT_SCENE_COVERAGE_H
#define LAMBENT_SCENE_COVERAGE_H

#include "shared/owen.h"
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

// The lowest bits of a ray's mask (raytracing/ray_records.h) tell what it meets. Where they are
// just the first, all, those above carry a number of the pixel whose sample the ray is, and which
// sample.
const uint kMeetingMaskBits = 0xFu;
const uint kSampleMaskShift = 4u, kSampleMaskBits = 0xFFu;
const uint kPixelMaskShift = 12u;

/// The mask of a ray from the camera that meets all.
LAMBENT_FN uint sample_mask(uint pixel, uint sample_index, uint seed) {
  uint number = hash_pcg3d(uvec3(pixel, sample_index / (kSampleMaskBits + 1u), seed)).x;
  return 1u | ((sample_index & kSampleMaskBits) << kSampleMaskShift) |
         ((number >> kPixelMaskShift) << kPixelMaskShift);
}

LAMBENT_FN bool carries_sample(uint ray_mask) {
  return (ray_mask & kMeetingMaskBits) == 1u;
}

/// A random number in [0, 1) that belongs to a pixel's sample at a triangle. Those of a pixel's
/// first 2^k samples lie in as many equal parts: a quarter of four rays is let through where a
/// quarter is to be. The radical inverse of the sample, scrambled.
LAMBENT_FN float uniform_of_sample(uint ray_mask, uint instance, uint triangle) {
  uint seed = hash_pcg(hash_pcg3d(uvec3(ray_mask >> kPixelMaskShift, instance, triangle)).x);
  uint index = (ray_mask >> kSampleMaskShift) & kSampleMaskBits;
  return uniform_from_bits(bitfieldReverse(scramble_reversed(index, seed)));
}

/// Probability that a ray which meets coverage `alpha` is stopped.
LAMBENT_FN float stopping_probability(uint alpha_mode, float alpha_cutoff, float alpha) {
  if (alpha_mode == kAlphaMask) return alpha >= alpha_cutoff ? 1.0f : 0.0f;
  if (alpha_mode == kAlphaBlend) return clamp(alpha, 0.0f, 1.0f);
  return 1.0f;
}

/// Whether coverage `alpha` stops a ray for which chance drew this number.
LAMBENT_FN bool stops_ray(uint alpha_mode, float alpha_cutoff, float alpha, float uniform_number) {
  if (alpha_mode == kAlphaMask) return alpha >= alpha_cutoff;
  if (alpha_mode == kAlphaBlend) return alpha > uniform_number;
  return true;
}

LAMBENT_END
#endif
