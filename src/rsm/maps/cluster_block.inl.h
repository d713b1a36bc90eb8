// SPDX-License-Identifier: Apache-2.0
// The clusters of a block of texels, in the common subset of C++ and GLSL. The includer provides
//   RsmTexelRecord fetch_block_texel(int k)
//       texel k of the block, rows from the top; without flux where the map has none
//   void put_cluster(int index, RsmTexelRecord texel, int seed)
//       receives the block's clusters; `seed` is the brightest of the texels
// In C++ it is included in the body of a struct that has these as members.

/// The brightest of the texels that are set in a mask; the first of equals.
LAMBENT_FN int brightest_of(uint texels) {
  int best = -1;
  float most = -1.0f;
  for (int k = 0; k < kBlockEdge * kBlockEdge; ++k) {
    if ((texels & (1u << k)) == 0u) continue;
    float power = power_of(fetch_block_texel(k).flux);
    if (power <= most) continue;
    most = power;
    best = k;
  }
  return best;
}

/// Divides the lit texels of the block by surface, brightest first, and returns the number of
/// clusters.
LAMBENT_FN int cluster_block() {
  uint left = 0u;
  for (int k = 0; k < kBlockEdge * kBlockEdge; ++k) {
    if (power_of(fetch_block_texel(k).flux) > 0.0f) left |= 1u << k;
  }
  int count = 0;
  for (; count < kBlockSurfaces && left != 0u; ++count) {
    int seed = brightest_of(left);
    RsmTexelRecord first = fetch_block_texel(seed);
    float edge = float(kBlockEdge) * sqrt(first.area);
    ClusterSum sum = empty_cluster();
    for (int k = 0; k < kBlockEdge * kBlockEdge; ++k) {
      if ((left & (1u << k)) == 0u) continue;
      RsmTexelRecord texel = fetch_block_texel(k);
      // The last cluster takes all remaining texels
      if (count + 1 < kBlockSurfaces && !same_surface(texel, first, edge)) continue;
      add_to_cluster(sum, texel, first, edge);
      left &= ~(1u << k);
    }
    put_cluster(count, cluster_texel(sum, first), seed);
  }
  return count;
}
