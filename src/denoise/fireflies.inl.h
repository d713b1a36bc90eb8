// SPDX-License-Identifier: Apache-2.0
// Fireflies: pixels that a single rare sample made far brighter than all pixels around them. Passes
// that compare light would leave them as they are, as their neighbours are known to be darker. In
// the common subset of C++ and GLSL. The includer provides the type
//   NoisyPixelRef  a pixel of a picture
// and
//   float fetch_luminance(NoisyPixelRef pixel, int x, int y)
//       the luminance of the pixel that is offset by (x, y), as it was sampled; 0 outside

/// The share of a pixel's light that is taken off it and spread over its surface, 0 to 1.
/// `variance`: of its luminance, as its samples measure it.
LAMBENT_FN float firefly_share(NoisyPixelRef pixel, float variance) {
  float own = fetch_luminance(pixel, 0, 0);
  if (!(variance >= kFireflyNoise * kFireflyNoise * own * own)) return 0.0f;
  // Of the eight neighbours, one may be a firefly, too
  float first = 0.0f;
  float second = 0.0f;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      if (x == 0 && y == 0) continue;
      float there = fetch_luminance(pixel, x, y);
      second = max(second, min(first, there));
      first = max(first, there);
    }
  }
  float most = kFireflyOverNeighbours * second;
  return own > most ? 1.0f - most / own : 0.0f;
}
