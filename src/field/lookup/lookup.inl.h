// SPDX-License-Identifier: Apache-2.0
// The lookup of the irradiance field, in the common subset of C++ and GLSL. The includer provides
//   ProbeGrid fetch_grid(int volume)
//   vec2 fetch_moments(ProbeGrid grid, int probe, vec3 direction)
//       mean distance [m] and mean squared distance [m^2], bilinear; of a probe of that grid, along
//       a direction of any length
//   vec3 fetch_offset(int probe)
//       of the probe from its place on the grid, in shares of a cell
//   vec3 fetch_irradiance(int probe, vec3 direction)
//       linear irradiance [W/m^2], bilinear
// In C++ it is included in the body of a struct that has these as members.

/// Where a probe stands.
LAMBENT_FN vec3 placed_probe(ProbeGrid grid, ivec3 coords) {
  return grid_position(grid, vec3(coords) + fetch_offset(probe_index(grid, coords)));
}

/// The cosine between a surface's normal and the direction to a probe.
LAMBENT_FN float probe_cosine(vec3 probe_ws, vec3 position_ws, vec3 normal_ws) {
  vec3 to_probe = probe_ws - position_ws;
  return dot(to_probe, normal_ws) / max(length(to_probe), kMinProbeDistance);
}

/// How much a probe counts for a point with a normal, before trilinear interpolation. `biased_ws`
/// is where visibility is asked.
LAMBENT_FN float lookup_weight(ProbeGrid grid, ivec3 coords, vec3 position_ws, vec3 normal_ws,
                               vec3 biased_ws) {
  vec3 probe_ws = placed_probe(grid, coords);

  // Ask the probe how far it sees along the direction to the biased point
  vec3 from_probe = biased_ws - probe_ws;
  float dist = max(length(from_probe), kMinProbeDistance);
  vec2 moments = fetch_moments(grid, probe_index(grid, coords), from_probe);

  // Weigh it by visibility and by its side of the surface
  return probe_weight(probe_cosine(probe_ws, position_ws, normal_ws), moments, dist);
}

/// Irradiance at a point with a normal, seen from `to_viewer_ws`, as the probes of one volume have
/// it, times the volume's share of what is left to answer; and that share. Averages linear light,
/// so that the result is linear in what the probes hold.
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
  // Where the volume knows nothing, coarser ones answer for it
  return weight_sum > 0.0f ? vec4(sum * (volume_weight / weight_sum), volume_weight) : vec4(0.0f);
}

/// The same over all volumes: each answers for its share of what those before it left, the last one
/// for the rest.
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
  // Where it is the last that knows nothing, those before answer for all
  return answer.w > 0.0f ? vec3(answer) / answer.w : vec3(0.0f);
}
