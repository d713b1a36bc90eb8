// SPDX-License-Identifier: Apache-2.0
// Upsampling of direct light from a view's pixels to a frame's samples, in the common subset of C++
// and GLSL. The includer provides, for the view,
//   vec3 fetch_position(int pixel)              [m]
//   vec3 fetch_normal(int pixel)                unit; 0 where nothing is seen
//   ReflectedPair fetch_direct(int pixel)
// In C++ it is included in the body of a struct that has these as members.

/// Light at a surface at `place` of the view, interpolated between pixels that show the surface. A
/// sample at a pixel of the view has that pixel's light alone, so that shadows keep their edges.
/// Where none of the four pixels around shows the surface, it is the mean of those 3 x 3 that do;
/// where none of these does, of all. `inverse_tolerance`: see relit_bilateral_weight().
LAMBENT_FN ReflectedPair upsample_direct(ivec2 size, vec2 place, vec3 position_ws, vec3 normal_ws,
                                         float inverse_tolerance) {
  ivec2 middle = ivec2(int(floor(place.x + 0.5f)), int(floor(place.y + 0.5f)));
  // Where the view is as fine as the frame, places are pixels, and most show the sample's surface
  bool inside = middle.x >= 0 && middle.y >= 0 && middle.x < size.x && middle.y < size.y;
  if (inside && place == vec2(middle)) {
    int own = middle.y * size.x + middle.x;
    float same = cross_bilateral_weight(position_ws - fetch_position(own), normal_ws,
                                        fetch_normal(own), inverse_tolerance);
    if (same > kShowsSurface) return fetch_direct(own);
  }
  ReflectedPair sums[3];
  float weights[3];
  for (int s = 0; s < 3; ++s) {
    sums[s].diffuse = vec3(0.0f);
    sums[s].specular = vec3(0.0f);
    weights[s] = 0.0f;
  }
  for (int k = 0; k < 9; ++k) {
    ivec2 pixel = ivec2(middle.x + k % 3 - 1, middle.y + k / 3 - 1);
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y) continue;
    int i = pixel.y * size.x + pixel.x;
    vec3 other_normal = fetch_normal(i);
    if (other_normal == vec3(0.0f)) continue;
    ReflectedPair light = fetch_direct(i);
    float same = cross_bilateral_weight(position_ws - fetch_position(i), normal_ws, other_normal,
                                        inverse_tolerance);
    float between = max(0.0f, 1.0f - abs(place.x - float(pixel.x))) *
                    max(0.0f, 1.0f - abs(place.y - float(pixel.y)));
    for (int s = 0; s < 3; ++s) {
      float weight = s == 0 ? between * same : s == 1 ? same : nearness(place, pixel);
      sums[s].diffuse += weight * light.diffuse;
      sums[s].specular += weight * light.specular;
      weights[s] += weight;
    }
  }
  for (int s = 0; s < 3; ++s) {
    if (weights[s] <= (s < 2 ? kShowsSurface : 0.0f)) continue;
    sums[s].diffuse /= weights[s];
    sums[s].specular /= weights[s];
    return sums[s];
  }
  return sums[2];
}
