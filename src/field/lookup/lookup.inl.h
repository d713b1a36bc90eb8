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

/// Irradiance at a point with a normal, seen along `to_viewer_ws` from `viewer_distance` [m], from
/// the probes of one volume.
/// Returns the irradiance times the volume's weight, and the weight as the fourth channel; all 0
/// where no probe has a weight. Averages linear light, so that the result is linear in what the
/// probes hold.
LAMBENT_FN vec4 lookup_volume(ProbeGrid grid, int volume_index, float volume_weight,
                              vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                              float viewer_distance) {
  LookupGrid volume = lookup_grid(grid);
  LookupCell cell = lookup_cell(volume, position_ws, normal_ws, to_viewer_ws, viewer_distance);

  vec3 sum = vec3(0.0f);
  float weight_sum = 0.0f;
  LAMBENT_UNROLL for (int k = 0; k < kCellCorners; ++k) {
    ivec3 corner = cell_corner(k);
    float weight = lookup_weight(volume, cell, corner, position_ws, normal_ws);
    sum += fetch_irradiance(probe_index(grid, cell.cell.base + corner), normal_ws) * weight;
    weight_sum += weight;
  }
  // Where no probe of this volume has a weight, the next volumes answer
  if (!(weight_sum > 0.0f)) return vec4(0.0f);
  float ratio = fetch_correction(grid, volume_index, position_ws, normal_ws);
  return vec4(sum * (ratio * volume_weight / weight_sum), volume_weight);
}

/// Irradiance at a point with a normal from all volumes, in order: each volume takes the share
/// volume_blend_weight() of the weight that the volumes before it have left, and the last one takes
/// the rest.
LAMBENT_FN vec3 lookup_irradiance(int volumes, vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                                  float viewer_distance) {
  vec4 answer = vec4(0.0f);
  for (int volume = 0; volume < volumes && answer.w < 1.0f; ++volume) {
    ProbeGrid grid = fetch_grid(volume);
    float volume_weight = volume + 1 == volumes ? 1.0f : volume_blend_weight(grid, position_ws);
    if (volume_weight <= 0.0f) continue;
    answer += lookup_volume(grid, volume, volume_weight * (1.0f - answer.w), position_ws, normal_ws,
                            to_viewer_ws, viewer_distance);
  }
  // Where no probe of the last volume has a weight, the volumes before it answer alone
  return answer.w > 0.0f ? vec3(answer) / answer.w : vec3(0.0f);
}
