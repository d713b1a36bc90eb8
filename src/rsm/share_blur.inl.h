// SPDX-License-Identifier: Apache-2.0
// The blur of arriving and unoccluded light, in the common subset of C++ and GLSL. The includer
// provides, for pixels of the view,
//   vec3 fetch_position(int pixel)       [m]
//   vec3 fetch_normal(int pixel)         unit; 0 where nothing is seen
//   float fetch_depth(int pixel)         [m]
//   LightShare fetch_share(int pixel)
// In C++ it is included in the body of a struct that has these as members.

/// Sums of arriving and unoccluded light around a pixel along `axis`, (1, 0) or (0, 1), over a box
/// as wide as `period`, of pixels of the same surface. They need not be means, as only their ratio
/// is used. `inverse_plane_tolerance`: one over RsmSettings::plane_tolerance.
LAMBENT_FN LightShare blurred_share(ivec2 at, ivec2 size, ivec2 axis, int period,
                                    float inverse_plane_tolerance) {
  int here = at.y * size.x + at.x;
  LightShare sum = fetch_share(here);
  vec3 normal = fetch_normal(here);
  if (normal == vec3(0.0f)) return sum;
  vec3 position = fetch_position(here);
  float inverse_tolerance = inverse_plane_tolerance / fetch_depth(here);
  for (int k = 2; k < 2 * (period / 2) + 2; ++k) {
    int dist = k / 2;
    int along = k % 2 == 0 ? -dist : dist;
    ivec2 place = ivec2(at.x + axis.x * along, at.y + axis.y * along);
    if (place.x < 0 || place.y < 0 || place.x >= size.x || place.y >= size.y) continue;
    int other = place.y * size.x + place.x;
    vec3 other_normal = fetch_normal(other);
    if (other_normal == vec3(0.0f)) continue;
    float same = relit_bilateral_weight(position - fetch_position(other), normal, other_normal,
                                        inverse_tolerance);
    float weight = period_weight(dist, period) * max(kOtherSurfaceWeight, same);
    LightShare share = fetch_share(other);
    sum.arrived += weight * share.arrived;
    sum.sent += weight * share.sent;
  }
  return sum;
}
