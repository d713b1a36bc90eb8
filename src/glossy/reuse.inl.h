// SPDX-License-Identifier: Apache-2.0
// Reflected light of a pixel from the rays around it, in the common subset of C++ and GLSL. The
// includer provides the type
//   CoatViewRef   pixels and their rays
// and
//   CoatLobe fetch_lobe(CoatViewRef view, ivec2 pixel)   of a pixel that has a ray
//   CoatRay fetch_ray(CoatViewRef view, ivec2 pixel)
//   ivec2 view_size(CoatViewRef view)                    of the picture [pixels]

/// Light that a pixel's coat reflects of rays. Takes the pixel's own ray, which `at` holds, and
/// those of the pixels around it in every `rows`-th row. The outermost have half their weight, so
/// that the total is that of 4 x 4 rays.
LAMBENT_FN ReflectedRays reuse_rays(CoatViewRef view, ivec2 pixel, CoatReceiver at,
                                    uint sample_index, uint rows) {
  CoatSums sums = no_coat_sums();
  ivec2 size = view_size(view);
  int reach = kReuse * int(rows);
  for (int dy = -reach; dy <= reach; ++dy) {
    int y = pixel.y + dy;
    if (y < 0 || y >= size.y || !has_coat_rays(y, sample_index, rows)) continue;
    float row_weight = abs(dy) == reach ? 0.5f : 1.0f;
    for (int dx = -kReuse; dx <= kReuse; ++dx) {
      int x = pixel.x + dx;
      if (x < 0 || x >= size.x || (dx == 0 && dy == 0)) continue;
      CoatRay ray = fetch_ray(view, ivec2(x, y));
      if (ray.pdf == 0.0f) continue;
      float weight = abs(dx) == kReuse ? 0.5f * row_weight : row_weight;
      add_coat_ray(at, fetch_lobe(view, ivec2(x, y)), ray, weight, sums);
    }
  }
  return reflected_rays(at, sums);
}
