// SPDX-License-Identifier: Apache-2.0
// The weights of probes in a lookup, for callers that read the field more than once with the same
// weights. Included after lookup.inl.h, with the same requirements.

/// The weights of the eight probes around a point in one volume. They sum to 1, or to 0 where all
/// of these probes are inside geometry.
LAMBENT_FN CornerWeights lookup_weights(ProbeGrid grid, int volume, vec3 position_ws,
                                        vec3 normal_ws, vec3 to_viewer_ws) {
  vec3 biased_ws = biased_position(position_ws, normal_ws, to_viewer_ws, smallest_spacing(grid));
  ProbeCell cell = probe_cell(grid, position_ws);
  CornerWeights weights;
  weights.base = probe_index(grid, cell.base);
  weights.table = uint(kCellWraps * volume + cell_wrap(grid, cell.base));
  float sum = 0.0f;
  for (int corner = 0; corner < kCellCorners; ++corner) {
    ivec3 offset = cell_corner(corner);
    float weight = lookup_weight(grid, cell.base + offset, position_ws, normal_ws, biased_ws) *
                   trilinear_weight(cell.fraction, offset);
    weights.weight[corner] = weight;
    sum += weight;
  }
  float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
  for (int corner = 0; corner < kCellCorners; ++corner) weights.weight[corner] *= scale;
  return weights;
}
