// SPDX-License-Identifier: Apache-2.0
// Visibility of probes by rays, in the common subset of C++ and GLSL. The includer provides
//   vec3 fetch_offset(int probe)
//       offset of the probe from its place on the grid [cells]
// In C++, this file is included in the body of a struct that has this as a member.

/// The position of a probe, with its offset.
LAMBENT_FN vec3 placed_probe(ProbeGrid grid, ivec3 coords) {
  return placed_position(grid, coords, fetch_offset(probe_index(grid, coords)));
}

/// A ray from the biased position of a lookup to a corner of its cell. The biased position is off
/// the surface, so that rounding cannot make the ray hit the surface itself.
LAMBENT_FN RayRecord corner_ray(ProbeGrid grid, LookupCell cell, int corner) {
  return visibility_ray(cell.biased_ws, placed_probe(grid, cell.cell.base + cell_corner(corner)));
}

/// Exact visibility: the weights that the corners of a lookup have if they are visible. `corners`
/// has weights by distances. Probes inside geometry have none, and get none here.
LAMBENT_FN CornerWeights visible_corners(LookupGrid volume, LookupCell cell, CornerWeights corners,
                                         vec3 position_ws, vec3 normal_ws) {
  for (int k = 0; k < kCellCorners; ++k) {
    if (!(corners.weight[k] > 0.0f)) continue;
    ivec3 corner = cell_corner(k);
    vec3 offset = fetch_offset(probe_index(volume.grid, cell.cell.base + corner));
    LookupCorner at = lookup_corner(volume, cell, corner, offset, position_ws, normal_ws);
    corners.weight[k] = visible_weight(at.trilinear, at.wrap);
  }
  return corners;
}
