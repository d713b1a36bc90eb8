// SPDX-License-Identifier: Apache-2.0
// The lookup of the irradiance field, in the common subset of C++ and GLSL. The includer provides
//   ProbeGrid fetch_grid(int volume)
//   vec2 fetch_moments(int probe, vec3 direction)
//       mean distance [distance_unit] and mean squared distance of a probe, bilinear, along a
//       direction of any length
//   vec3 fetch_offset(int probe)
//       offset of the probe from its place on the grid [cells]
//   vec3 fetch_irradiance(int probe, vec3 direction)
//       linear irradiance [W/m^2], bilinear
//   float fetch_correction(ProbeGrid grid, int volume, vec3 position_ws, vec3 normal_ws)
//       the factor that corrects the lookup in a volume at a point with a normal, see
//       correction_at() of field/correction/correction.inl.h; 1 where none is known
// In C++, this file is included in the body of a struct that has these as members.

/// The weight of a corner for a point with a normal.
LAMBENT_FN float lookup_weight(LookupGrid volume, LookupCell cell, ivec3 corner, vec3 position_ws,
                               vec3 normal_ws) {
  int probe = probe_index(volume.grid, cell.cell.base + corner);
  LookupCorner at =
      lookup_corner(volume, cell, corner, fetch_offset(probe), position_ws, normal_ws);
  return corner_weight(at.wrap, at.trilinear, at.dist, fetch_moments(probe, at.from_probe));
}

/// The weights of the corners around a point with a normal, with visibility by distances.
LAMBENT_FN CornerWeights corner_weights(LookupGrid volume, LookupCell cell, vec3 position_ws,
                                        vec3 normal_ws) {
  CornerWeights corners;
  corners.base = probe_index(volume.grid, cell.cell.base);
  corners.table = 0u;
  LAMBENT_UNROLL for (int k = 0; k < kCellCorners; ++k) {
    corners.weight[k] = lookup_weight(volume, cell, cell_corner(k), position_ws, normal_ws);
  }
  return corners;
}

/// Irradiance at a point with a normal from the corners of a cell of one volume.
/// Returns the irradiance times the volume's weight, and that weight as the fourth channel; all 0
/// where no corner has a weight. Averages linear light, so that the result is linear in what the
/// probes hold.
LAMBENT_FN vec4 irradiance_of_corners(ProbeGrid grid, int volume_index, float volume_weight,
                                      LookupCell cell, CornerWeights corners, vec3 position_ws,
                                      vec3 normal_ws) {
  float weight_sum = sum_of_weights(corners);
  // Where no probe of this volume has a weight, the next volumes answer
  if (!(weight_sum > 0.0f)) return vec4(0.0f);
  vec3 sum = vec3(0.0f);
  LAMBENT_UNROLL for (int k = 0; k < kCellCorners; ++k) {
    int probe = probe_index(grid, cell.cell.base + cell_corner(k));
    sum += fetch_irradiance(probe, normal_ws) * corners.weight[k];
  }
  float ratio = fetch_correction(grid, volume_index, position_ws, normal_ws);
  return vec4(sum * (ratio * volume_weight / weight_sum), volume_weight);
}

/// irradiance_of_corners() around a point that is seen along `to_viewer_ws` from `viewer_distance`
/// [m], with visibility by distances.
LAMBENT_FN vec4 lookup_volume(ProbeGrid grid, int volume_index, float volume_weight,
                              vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                              float viewer_distance) {
  LookupGrid volume = lookup_grid(grid);
  LookupCell cell = lookup_cell(volume, position_ws, normal_ws, to_viewer_ws, viewer_distance);
  CornerWeights corners = corner_weights(volume, cell, position_ws, normal_ws);
  return irradiance_of_corners(grid, volume_index, volume_weight, cell, corners, position_ws,
                               normal_ws);
}

/// Irradiance at a point with a normal from all volumes, in order: each volume takes volume_share()
/// of the weight that the volumes before it have left.
LAMBENT_FN vec3 lookup_irradiance(int volumes, vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                                  float viewer_distance) {
  vec4 answer = vec4(0.0f);
  for (int volume = 0; volume < volumes && answer.w < 1.0f; ++volume) {
    ProbeGrid grid = fetch_grid(volume);
    float volume_weight = volume_share(grid, volume, volumes, position_ws) * (1.0f - answer.w);
    if (volume_weight <= 0.0f) continue;
    answer += lookup_volume(grid, volume, volume_weight, position_ws, normal_ws, to_viewer_ws,
                            viewer_distance);
  }
  // Where no probe of the last volume has a weight, the volumes before it answer alone
  return answer.w > 0.0f ? vec3(answer) / answer.w : vec3(0.0f);
}
