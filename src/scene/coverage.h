// SPDX-License-Identifier: Apache-2.0
// Stochastic transparency: which rays are stopped by triangles that are see-through.
#ifndef LAMBENT_SCENE_COVERAGE_H
#define LAMBENT_SCENE_COVERAGE_H

#include "shared/owen.h"
#include "shared/random.h"

LAMBENT_BEGIN

/// The values of AlphaMode in scene.h.
const uint kAlphaOpaque = 0u;
const uint kAlphaMask = 1u;
const uint kAlphaBlend = 2u;

/// Decorrelates hits of neighbouring triangles: 2^32 over the golden ratio.
const uint kTriangleHashStep = 0x9E3779B9u;

/// Decorrelates random decisions at glass from those by coverage.
const uint kGlassSalt = 0x85EBCA6Bu;

/// A random number in [0, 1) that depends on this hit alone, so that coverage is decided without
/// state.
LAMBENT_FN float uniform_of_hit(vec2 barycentrics, float distance, uint triangle) {
  uvec3 mixed = hash_pcg3d(uvec3(floatBitsToUint(barycentrics.x) ^ (triangle * kTriangleHashStep),
                                 floatBitsToUint(barycentrics.y), floatBitsToUint(distance)));
  return uniform_from_bits(mixed.x);
}

// The mask of a camera ray that encodes its pixel and sample:
//   bits 0 to 3    1, which tells such masks from all others (raytracing/ray_records.h) and, as all
//                  instances have the lowest bit, that it meets all of them
//   bits 4 to 11   the sample, modulo 256
//   bits 12 to 31  a hash of the pixel
const uint kKindMaskBits = 0xFu, kSampleMaskKind = 1u;
const uint kSampleMaskShift = 4u, kSampleMaskBits = 0xFFu;
const uint kPixelMaskShift = 12u;

LAMBENT_FN uint sample_mask(uint pixel, uint sample_index, uint seed) {
  uint number = hash_pcg3d(uvec3(pixel, sample_index / (kSampleMaskBits + 1u), seed)).x;
  return kSampleMaskKind | ((sample_index & kSampleMaskBits) << kSampleMaskShift) |
         ((number >> kPixelMaskShift) << kPixelMaskShift);
}

LAMBENT_FN bool carries_sample(uint ray_mask) {
  return (ray_mask & kKindMaskBits) == kSampleMaskKind;
}

// Bits of a distance that tell layers apart: exponent and seven of the significand. Layers are as
// thick as 1/256 to 1/128 of the distance, so that folds of a curtain decide each for itself, while
// the samples of a pixel on one fold share a layer, unless it is seen edge-on.
const uint kLayerShift = 16u;

LAMBENT_FN uint coverage_layer(float distance) {
  return floatBitsToUint(distance) >> kLayerShift;
}

/// A random number in [0, 1) for a pixel's sample at a layer of an instance: the sample's radical
/// inverse, scrambled. A pixel's first 2^k samples are stratified, so that for example one of four
/// rays is stopped where the probability is a quarter, whichever triangles of a fine mesh they hit.
LAMBENT_FN float uniform_of_sample(uint ray_mask, uint instance, uint layer) {
  uint seed = hash_pcg(hash_pcg3d(uvec3(ray_mask >> kPixelMaskShift, instance, layer)).x);
  uint index = (ray_mask >> kSampleMaskShift) & kSampleMaskBits;
  return uniform_from_bits(bitfieldReverse(scramble_reversed(index, seed)));
}

/// Probability that a ray is stopped by coverage `alpha`.
LAMBENT_FN float stopping_probability(uint alpha_mode, float alpha_cutoff, float alpha) {
  if (alpha_mode == kAlphaMask) return alpha >= alpha_cutoff ? 1.0f : 0.0f;
  if (alpha_mode == kAlphaBlend) return clamp(alpha, 0.0f, 1.0f);
  return 1.0f;
}

/// Whether coverage `alpha` stops a ray, given its uniform random number.
LAMBENT_FN bool stops_ray(uint alpha_mode, float alpha_cutoff, float alpha, float uniform_number) {
  if (alpha_mode == kAlphaMask) return alpha >= alpha_cutoff;
  if (alpha_mode == kAlphaBlend) return alpha > uniform_number;
  return true;
}

LAMBENT_END
#endif
