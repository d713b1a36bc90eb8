// SPDX-License-Identifier: Apache-2.0
// The weights of probes in a lookup, for callers that read the field more than once with the same
// weights. Included after lookup.inl.h, with the same requirements.

/// The weights of the eight probes around a point in one volume. They sum to 1, or to 0 where all
/// of these probes are inside geometry.
LAMBENT_FN CornerWeights lookup_weights(ProbeGrid grid, int volume, vec3 position_ws,
                                        vec3 normal_ws, vec3 to_viewer_ws) {
  LookupGrid in_volume = lookup_grid(grid);
  LookupCell cell = lookup_cell(in_volume, position_ws, normal_ws, to_viewer_ws);
  CornerWeights weights;
  weights.base = probe_index(grid, cell.cell.base);
  weights.table = uint(kCellWraps * volume + cell_wrap(grid, cell.cell.base));
  for (int k = 0; k < kCellCorners; ++k) {
    weights.weight[k] = lookup_weight(in_volume, cell, cell_corner(k), position_ws, normal_ws);
  }
  normalize_weights(weights);
  return weights;
}
