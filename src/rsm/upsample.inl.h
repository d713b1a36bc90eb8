// SPDX-License-Identifier: Apache-2.0
// Upsampling, in the common subset of C++ and GLSL. The includer provides, for the small picture,
//   vec3 fetch_position(int pixel)   [m]
//   vec3 fetch_normal(int pixel)     unit; 0 where nothing is seen
//   vec3 fetch_light(int pixel)
// In C++ it is included in the body of a struct that has these as members.

/// Light at a surface at `place` of the small picture, from those of the 3 x 3 pixels around that
/// show the same surface; where none does, from all that show any. `inverse_tolerance`: see
/// relit_bilateral_weight().
LAMBENT_FN vec3 upsample_light(ivec2 size, vec2 place, vec3 position_ws, vec3 normal_ws,
                               float inverse_tolerance) {
  ivec2 middle = ivec2(int(floor(place.x + 0.5f)), int(floor(place.y + 0.5f)));
  vec3 sum = vec3(0.0f);
  vec3 any = vec3(0.0f);
  float weights = 0.0f;
  float any_weights = 0.0f;
  for (int k = 0; k < 9; ++k) {
    ivec2 pixel = ivec2(middle.x + k % 3 - 1, middle.y + k / 3 - 1);
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y) continue;
    int i = pixel.y * size.x + pixel.x;
    vec3 other_normal = fetch_normal(i);
    if (other_normal == vec3(0.0f)) continue;
    vec3 light = fetch_light(i);
    float near = nearness(place, pixel);
    float weight = near * cross_bilateral_weight(position_ws - fetch_position(i), normal_ws,
                                                 other_normal, inverse_tolerance);
    sum += weight * light;
    weights += weight;
    any += near * light;
    any_weights += near;
  }
  if (weights > kLeastUpsampleWeight) return sum / weights;
  return any_weights > 0.0f ? any / any_weights : vec3(0.0f);
}
