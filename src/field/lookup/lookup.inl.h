// SPDX-License-Identifier: Apache-2.0
// The lookup of the irradiance field, in the common subset of C++ and GLSL. The includer provides
//   ProbeGrid fetch_grid(int volume)
//   vec2 fetch_moments(ProbeGrid grid, int probe, vec3 direction)
//       mean distance [m] and mean squared distance [m^2] of a probe of that grid, bilinear, along
//       a direction of any length
//   vec3 fetch_offset(int probe)
//       offset of the probe from its place on the grid [cells]
//   vec3 fetch_irradiance(int probe, vec3 direction)
//       linear irradiance [W/m^2], bilinear
// In C++, this file is included in the body of a struct that has these as members.

/// The position of a probe, with its offset.
LAMBENT_FN vec3 placed_probe(ProbeGrid grid, ivec3 coords) {
  return grid_position(grid, vec3(coords) + fetch_offset(probe_index(grid, coords)));
}

/// The cosine between a surface's normal and the direction to a probe.
LAMBENT_FN float probe_cosine(vec3 probe_ws, vec3 position_ws, vec3 normal_ws) {
  vec3 to_probe = probe_ws - position_ws;
  return dot(to_probe, normal_ws) / max(length(to_probe), kMinProbeDistance);
}

/// The weight of a probe for a point with a normal, before trilinear interpolation. `biased_ws` is
/// the point at which visibility is evaluated.
LAMBENT_FN float lookup_weight(ProbeGrid grid, ivec3 coords, vec3 position_ws, vec3 normal_ws,
                               vec3 biased_ws) {
  vec3 probe_ws = placed_probe(grid, coords);

  // Fetch the distances that the probe sees along the direction to the biased point
  vec3 from_probe = biased_ws - probe_ws;
  float dist = max(length(from_probe), kMinProbeDistance);
  vec2 moments = fetch_moments(grid, probe_index(grid, coords), from_probe);

  // Combine visibility and the wrap-shading weight
  return probe_weight(probe_cosine(probe_ws, position_ws, normal_ws), moments, dist);
}

/// Irradiance at a point with a normal, seen from `to_viewer_ws`, from the probes of one volume.
/// Returns the irradiance times the volume's weight, and the weight as the fourth channel; all 0
/// where no probe has a weight. Averages linear light, so that the result is linear in what the
/// probes hold.
LAMBENT_FN vec4 lookup_volume(ProbeGrid grid, float volume_weight, vec3 position_ws, vec3 normal_ws,
                              vec3 to_viewer_ws) {
  float spacing_min = smallest_spacing(grid);
  vec3 biased_ws = biased_position(position_ws, normal_ws, to_viewer_ws, spacing_min);
  ProbeCell cell = probe_cell(grid, position_ws);

  vec3 sum = vec3(0.0f);
  float weight_sum = 0.0f;
  LAMBENT_UNROLL for (int corner = 0; corner < kCellCorners; ++corner) {
    ivec3 offset = cell_corner(corner);
    ivec3 coords = cell.base + offset;
    float weight = lookup_weight(grid, coords, position_ws, normal_ws, biased_ws) *
                   trilinear_weight(cell.fraction, offset);
    sum += fetch_irradiance(probe_index(grid, coords), normal_ws) * weight;
    weight_sum += weight;
  }
  // Where no probe of this volume has a weight, the next volumes answer
  return weight_sum > 0.0f ? vec4(sum * (volume_weight / weight_sum), volume_weight) : vec4(0.0f);
}

/// Irradiance at a point with a normal from all volumes, in order: each volume takes its blend
/// weight of the weight that the volumes before it have left, and the last one takes the rest.
LAMBENT_FN vec3 lookup_irradiance(int volumes, vec3 position_ws, vec3 normal_ws,
                                  vec3 to_viewer_ws) {
  vec4 answer = vec4(0.0f);
  for (int volume = 0; volume < volumes && answer.w < 1.0f; ++volume) {
    ProbeGrid grid = fetch_grid(volume);
    float volume_weight = volume + 1 == volumes ? 1.0f : volume_blend_weight(grid, position_ws);
    if (volume_weight <= 0.0f) continue;
    answer += lookup_volume(grid, volume_weight * (1.0f - answer.w), position_ws, normal_ws,
                            to_viewer_ws);
  }
  // Where no probe of the last volume has a weight, the volumes before it answer alone
  return answer.w > 0.0f ? vec3(answer) / answer.w : vec3(0.0f);
}
