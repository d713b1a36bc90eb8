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
//   bits 12 to 15  the logarithm to base 2 of the number of the pixel's samples, rounded down
//   bit 16         1 where that number is no power of 2
//   bits 17 to 31  a hash of the pixel
const uint kKindMaskBits = 0xFu, kSampleMaskKind = 1u;
const uint kSampleMaskShift = 4u, kSampleMaskBits = 0xFFu;
const uint kSampleCountMaskShift = 12u, kSampleCountMaskBits = 0xFu;
const uint kMaxLog2Samples = 8u;  // samples are numbered modulo 256
const uint kOddCountMask = 1u << 16u;
const uint kPixelMaskShift = 17u;

/// A mask that meets all instances and carries no sample: kRayMeetsAll of raytracing/ray_records.h,
/// which this folder does not include. A test holds the two against each other.
const uint kChanceMask = 0xFFFFFFFFu;

/// The mask of the camera ray of one of a pixel's `samples` samples, at least 1.
LAMBENT_FN uint sample_mask(uint pixel, uint sample_index, uint samples, uint seed) {
  uint number = hash_pcg3d(uvec3(pixel, sample_index / (kSampleMaskBits + 1u), seed)).x;
  uint log2_samples = min(uint(findMSB(samples)), kMaxLog2Samples);
  uint mask = kSampleMaskKind | ((sample_index & kSampleMaskBits) << kSampleMaskShift) |
              (log2_samples << kSampleCountMaskShift) |
              ((number >> kPixelMaskShift) << kPixelMaskShift);
  return (samples & (samples - 1u)) != 0u ? mask | kOddCountMask : mask;
}

LAMBENT_FN bool carries_sample(uint ray_mask) {
  return (ray_mask & kKindMaskBits) == kSampleMaskKind;
}

/// The number of a pixel's sample, in [0, 1): its radical inverse, scrambled by the pixel. The
/// first 2^k of a pixel's samples lie in equal parts, so that of four samples exactly one is below
/// a quarter. Where the number of samples is a power of 2, the part of a frame's sample is that of
/// the same sample of all pixels: it shows a pane in all of its pixels or in none, and neighbours
/// tell of its light.
LAMBENT_FN float uniform_of_sample(uint ray_mask) {
  uint seed = hash_pcg(ray_mask >> kPixelMaskShift);
  uint index = (ray_mask >> kSampleMaskShift) & kSampleMaskBits;
  uint shared_digits = (ray_mask & kOddCountMask) != 0u
                           ? 0u
                           : (ray_mask >> kSampleCountMaskShift) & kSampleCountMaskBits;
  uint order = index & ((1u << shared_digits) - 1u);
  // Successive parts are of an even and an odd sample, as coats have rays in other rows of pixels
  // in each
  if (shared_digits > 1u) order ^= order >> (shared_digits - 1u);
  uint parts = bitfieldReverse(order);
  uint within = bitfieldReverse(scramble_reversed(index >> shared_digits, seed));
  return uniform_from_bits(parts | (within >> shared_digits));
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

/// What a material covers at a hit, see hit_coverage_at().
struct HitCoverage {
  uint mode;     ///< kAlphaOpaque, ...
  float cutoff;  ///< The least alpha that stops rays; for kAlphaMask.
  float alpha;   ///< 0 to 1.
};

/// Share of a pixel's sample that a surface covers which has stopped its ray: 1 unless blended.
LAMBENT_FN float covered_share(HitCoverage found) {
  return found.mode == kAlphaBlend ? clamp(found.alpha, 0.0f, 1.0f) : 1.0f;
}

/// Whether a surface dims a ray whose transmittance is asked for, by its covered_share(). Shadow
/// rays need no chance. For rays that cross glass, which may end at any surface, chance has
/// decided.
LAMBENT_FN bool dims_ray(HitCoverage found, bool ray_crosses_glass) {
  return found.mode == kAlphaBlend && !ray_crosses_glass;
}

/// Whether a triangle stops a ray with this mask that hits it at these barycentrics. Rays that
/// carry a pixel's sample stop at all blended surfaces that cover anything: whether the sample ends
/// there is found by ends_sample(), in the order of the surfaces. Blended surfaces up to the
/// distance `passed` [m] let all rays through.
LAMBENT_FN bool stops_ray(HitCoverage found, uint triangle, vec2 barycentrics, float distance,
                          uint ray_mask, float passed) {
  if (found.mode == kAlphaBlend && distance <= passed) return false;
  float uniform_number =
      carries_sample(ray_mask) ? 0.0f : uniform_of_hit(barycentrics, distance, triangle);
  return stops_ray(found.mode, found.cutoff, found.alpha, uniform_number);
}

/// How many blended surfaces a pixel's sample passes in their order. At those behind them chance
/// decides, as for all other rays: each surface costs a ray, and few pictures show more.
const uint kMaxOrderedSurfaces = 16u;

/// Surfaces whose distances differ by less than this, relative to themselves, are passed together:
/// some units in the last place, by which the distances of one hit may differ from ray to ray.
const float kSameDistance = 4.8e-7f;

/// OrderedCoverage::passed before the first surface.
const float kNothingPassed = -1.0f;

/// The blended surfaces that a pixel's sample has met, front to back. The sample ends at the first
/// surface where the share of the samples that end up to it exceeds its number. The numbers of a
/// pixel's samples lie in equal parts, and shares are whole numbers of samples where that is
/// possible, so that neighbouring pixels show a surface in as many samples. A sample's weight is
/// the surface's share of the pixel over its share of the samples.
struct OrderedCoverage {
  uint ray_mask;    ///< Of the ray that goes on.
  float number;     ///< The sample's, 0 to 1.
  float samples;    ///< Number of the pixel's samples, a power of 2.
  float open;       ///< Share of the pixel that the surfaces so far leave uncovered or, once the
                    ///< sample has ended, that its surface covers.
  float remaining;  ///< Share of the samples that go on or, once the sample has ended, that end
                    ///< where it does.
  float passed;     ///< Distance up to which blended surfaces have been passed [m].
  uint surfaces;    ///< Number of surfaces that have been passed.
};

LAMBENT_FN OrderedCoverage start_coverage(uint ray_mask) {
  OrderedCoverage met;
  met.ray_mask = ray_mask;
  met.number = uniform_of_sample(ray_mask);
  met.samples = float(1u << ((ray_mask >> kSampleCountMaskShift) & kSampleCountMaskBits));
  met.open = 1.0f;
  met.remaining = 1.0f;
  met.passed = kNothingPassed;
  met.surfaces = 0u;
  return met;
}

// A surface that covers at least kMinGuaranteedCoverage receives at least one of a pixel's samples,
// and one that leaves as much uncovered leaves at least one to what is behind it. For less, chance
// decides: its noise is faint, and a sample of four is dear. Chance also decides where fewer than
// kMinSamplesToGuarantee samples, or less than half of all, remain: otherwise stacks of thin
// surfaces would leave too few samples to what is behind them.
const float kMinGuaranteedCoverage = 1.0f / 64.0f, kMinSamplesToGuarantee = 4.0f;

/// The share of a pixel's samples that end at a surface of coverage `alpha`: a whole number of
/// them, unless the surface or what is behind it would receive none.
LAMBENT_FN float ending_share(OrderedCoverage met, float alpha) {
  float samples = met.remaining * met.samples;
  float ending = floor(alpha * samples + 0.5f);
  if (min(alpha, 1.0f - alpha) >= kMinGuaranteedCoverage &&
      samples >= max(kMinSamplesToGuarantee, 0.5f * met.samples)) {
    ending = clamp(ending, 1.0f, samples - 1.0f);
  }
  bool whole = alpha < 1.0f && ending >= 1.0f && ending <= samples - 1.0f;
  return whole ? ending / met.samples : met.remaining * alpha;
}

/// Whether a sample ends at the surface, of coverage `alpha`, that its ray met at `distance`.
/// Otherwise the surface is passed, and the ray goes on from restart_distance().
LAMBENT_FN bool ends_sample(LAMBENT_INOUT(OrderedCoverage) met, float alpha, float distance) {
  if (!carries_sample(met.ray_mask)) return true;
  float ending = ending_share(met, alpha);
  if (alpha >= 1.0f || 1.0f - met.remaining + ending > met.number) {
    met.open *= alpha;
    met.remaining = ending;
    return true;
  }
  met.open *= 1.0f - alpha;
  met.remaining -= ending;
  met.passed = distance * (1.0f + kSameDistance);
  met.surfaces += 1u;
  if (met.surfaces == kMaxOrderedSurfaces) met.ray_mask = kChanceMask;
  return false;
}

/// The weight of a sample that has ended, or whose ray left the scene, in the mean of the pixel's.
LAMBENT_FN float weight_of_sample(OrderedCoverage met) {
  return met.remaining > 0.0f ? met.open / met.remaining : 1.0f;
}

/// Where a ray that has passed a surface goes on [m]: just before it, for an opaque surface may lie
/// in the same place.
LAMBENT_FN float restart_distance(OrderedCoverage met) {
  return met.passed * (1.0f - 2.0f * kSameDistance);
}

LAMBENT_END
#endif
