// SPDX-License-Identifier: Apache-2.0
// Random numbers for the rays of pixels, as points of the unit square.
//
// The points of neighbouring pixels, and those of successive samples, cover the square evenly
// together, which makes filters over either effective: pixels along a Hilbert curve take successive
// points of one low-discrepancy sequence. Based on: Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences", 2018; Ahmed and Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo
// Sampling Error via Hierarchical Ordering of Pixels", SIGGRAPH Asia 2020.
#ifndef LAMBENT_SHARED_PIXEL_POINTS_H
#define LAMBENT_SHARED_PIXEL_POINTS_H

#include "shared/random.h"

LAMBENT_BEGIN

// Steps of Kronecker sequences, in units of 2^-32: from point to point the inverse powers of the
// plastic number, and from sample to sample those of the root of x^5 = x + 1 (Roberts's constant
// for four dimensions), which are independent of the former.
const uint kPlasticBitsX = 3242174889u;
const uint kPlasticBitsY = 2447445414u;
const uint kSampleBitsX = 3679390609u;
const uint kSampleBitsY = 3152041523u;

// The largest picture is 2^14 pixels wide.
const int kHilbertLevels = 14;

/// Place of a pixel along a Hilbert curve over 2^14 x 2^14 pixels. Hilbert, "Ueber die stetige
/// Abbildung einer Linie auf ein Flaechenstueck", 1891.
LAMBENT_FN uint hilbert_index(uint x, uint y) {
  uint index = 0u;
  for (int level = kHilbertLevels - 1; level >= 0; --level) {
    uint bit_x = (x >> uint(level)) & 1u;
    uint bit_y = (y >> uint(level)) & 1u;
    index = index * 4u + ((3u * bit_x) ^ bit_y);
    // Turn the quarter so that its curve begins where the one before ended
    if (bit_y == 0u) {
      if (bit_x == 1u) {
        x = ~x;
        y = ~y;
      }
      uint swapped = x;
      x = y;
      y = swapped;
    }
  }
  return index;
}

/// Point of the unit square for one of the rays that a pixel sends out in a sample.
LAMBENT_FN vec2 pixel_point(uint x, uint y, uint ray, uint rays_per_pixel, uint sample_index,
                            uint seed) {
  uint index = hilbert_index(x, y) * rays_per_pixel + ray;
  uint shift = hash_pcg(seed);
  return vec2(
      uniform_from_bits(index * kPlasticBitsX + sample_index * kSampleBitsX + shift),
      uniform_from_bits(index * kPlasticBitsY + sample_index * kSampleBitsY + hash_pcg(shift)));
}

LAMBENT_END
#endif
