// SPDX-License-Identifier: Apache-2.0
// The lookup of the irradiance field, in the common subset of C++ and GLSL. The includer provides
//   vec2 fetch_moments(int probe, vec3 direction)
//       mean distance [m] and mean squared distance [m^2], bilinear
//   vec3 fetch_offset(int probe)
//       of the probe from its place on the grid, in shares of a cell
//   vec3 fetch_irradiance(int probe, vec3 direction)
//       linear irradiance [W/m^2], bilinear
// In C++ it is included in the body of a struct that has these as members.

/// Irradiance at a point with a normal, seen from `to_viewer_ws`. Averages linear light, so that
/// the result is linear in what the probes hold.
LAMBENT_FN vec3 lookup_irradiance(ProbeGrid grid, vec3 position_ws, vec3 normal_ws,
                                  vec3 to_viewer_ws) {
  float spacing_min = min(grid.spacing.x, min(grid.spacing.y, grid.spacing.z));
  vec3 biased_ws = biased_position(position_ws, normal_ws, to_viewer_ws, spacing_min);
  ProbeCell cell = probe_cell(grid, position_ws);

  vec3 sum = vec3(0.0f);
  float weight_sum = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 offset = cell_corner(corner);
    ivec3 coords = cell.base + offset;
    int probe = probe_index(grid, coords);
    vec3 probe_ws = probe_position(grid, coords) + fetch_offset(probe) * grid.spacing;

    // Ask the probe how far it sees along the direction to the biased point
    vec3 from_probe = biased_ws - probe_ws;
    float dist = max(length(from_probe), kMinProbeDistance);
    vec2 moments = fetch_moments(probe, from_probe / dist);

    // Weigh it by visibility, by its side of the surface and by nearness
    vec3 to_probe = probe_ws - position_ws;
    float cos_probe = dot(to_probe, normal_ws) / max(length(to_probe), kMinProbeDistance);
    float weight = probe_weight(cos_probe, moments, dist) * trilinear_weight(cell.fraction, offset);

    sum += fetch_irradiance(probe, normal_ws) * weight;
    weight_sum += weight;
  }
  return weight_sum > 0.0f ? sum / weight_sum : vec3(0.0f);
}
