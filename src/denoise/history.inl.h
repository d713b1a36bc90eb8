// SPDX-License-Identifier: Apache-2.0
// Light of the previous frame at a pixel's reprojected surface, in the common subset of C++ and
// GLSL.
//
// Based on: Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, sec. 4.2; Nehab et
// al., "Accelerating Real-Time Shading with Reverse Reprojection Caching", GH 2007.
//
// The includer provides, for pixels of the previous frame,
//   float fetch_depth_before(int pixel)     [m]; 0 where nothing is seen
//   vec3 fetch_normal_before(int pixel)     geometric; unit
// In C++ it is included in the body of a struct that has these as members.

/// The four pixels of the previous frame around a place, and their weights: 0 where a pixel shows
/// another surface or nothing. Weights sum to 1, or to 0 where no pixel is valid. `place` [pixels]:
/// centres of pixels are at halves. `tolerance`: of depth [m].
LAMBENT_FN HistoryTaps history_taps(ivec2 size, vec2 place, float depth, float tolerance,
                                    vec3 normal_ws) {
  HistoryTaps taps;
  vec2 corner = place - vec2(0.5f);
  vec2 first = floor(corner);
  vec2 along = corner - first;
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k) {
    ivec2 step = ivec2(k % 2, k / 2);
    ivec2 pixel = ivec2(int(first.x), int(first.y)) + step;
    float weight =
        (step.x == 1 ? along.x : 1.0f - along.x) * (step.y == 1 ? along.y : 1.0f - along.y);
    taps.pixels[k] = 0;
    taps.weights[k] = 0.0f;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y) continue;
    int i = pixel.y * size.x + pixel.x;
    if (abs(fetch_depth_before(i) - depth) > tolerance) continue;
    if (dot(fetch_normal_before(i), normal_ws) < kSameSurfaceCosine) continue;
    taps.pixels[k] = i;
    taps.weights[k] = weight;
    sum += weight;
  }
  // A surface that was nearly hidden leaves too little history
  float scale = sum > kLeastHistoryWeight ? 1.0f / sum : 0.0f;
  for (int k = 0; k < 4; ++k) taps.weights[k] *= scale;
  return taps;
}
