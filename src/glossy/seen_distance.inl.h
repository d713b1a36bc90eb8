// SPDX-License-Identifier: Apache-2.0
// Distance to the hits of the rays around a pixel, in the common subset of C++ and GLSL. The
// includer provides the type
//   CoatViewRef   pixels and their rays
// and
//   float fetch_distance(CoatViewRef view, ivec2 pixel)   to its ray's hit [m]; below 0: no ray
//   ivec2 view_size(CoatViewRef view)                     of the picture [pixels]

/// Mean reciprocal of the distance to the hits of a pixel's ray and those around it [1/m]; 0 where
/// none hit anything. A single ray says little about what a rough coat reflects, and the filter
/// would treat a pixel whose ray found light differently from its neighbours.
LAMBENT_FN float seen_inverse_distance(CoatViewRef view, ivec2 pixel, uint sample_index,
                                       uint rows) {
  ivec2 size = view_size(view);
  int reach = kReuse * int(rows);
  float sum = 0.0f;
  float rays = 0.0f;
  for (int dy = -reach; dy <= reach; ++dy) {
    int y = pixel.y + dy;
    if (y < 0 || y >= size.y) continue;
    if (dy != 0 && !has_coat_rays(y, sample_index, rows)) continue;
    for (int dx = -kReuse; dx <= kReuse; ++dx) {
      int x = pixel.x + dx;
      if (x < 0 || x >= size.x) continue;
      float distance = fetch_distance(view, ivec2(x, y));
      if (distance < 0.0f) continue;
      rays += 1.0f;
      sum += inverse_seen_distance(distance);
    }
  }
  return rays > 0.0f ? sum / rays : 0.0f;
}
