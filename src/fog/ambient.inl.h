// SPDX-License-Identifier: Apache-2.0
// The lookup of a field at a point in the air, where no surface calls for a bias or rules out
// probes behind it. The includer provides what field/lookup/lookup.inl.h requires. In C++, this
// file is included in the body of a struct that has these as members.

/// Adds the irradiance around a ray at a point, from the probes of one volume, times its weight.
LAMBENT_FN void add_volume(ProbeGrid grid, float volume_weight, vec3 position_ws, Frame around_ray,
                           LAMBENT_INOUT(AmbientIrradiance) sum) {
  LookupGrid volume = lookup_grid(grid);
  LookupCell cell = lookup_cell(volume, position_ws, vec3(0.0f), vec3(0.0f), 0.0f);
  float weights[kCellCorners];
  float weight_sum = 0.0f;
  for (int k = 0; k < kCellCorners; ++k) {
    int probe = probe_index(grid, cell.cell.base + cell_corner(k));
    LookupCorner at =
        lookup_corner(volume, cell, cell_corner(k), fetch_offset(probe), position_ws, vec3(0.0f));
    weights[k] = corner_weight(1.0f, at.trilinear, at.dist, fetch_moments(probe, at.from_probe));
    weight_sum += weights[k];
  }
  if (!(weight_sum > 0.0f)) return;
  sum.weight += volume_weight;
  for (int k = 0; k < kCellCorners; ++k) {
    float weight = weights[k] * (volume_weight / weight_sum);
    if (!(weight > 0.0f)) continue;
    int probe = probe_index(grid, cell.cell.base + cell_corner(k));
    for (int i = 0; i < kAmbientDirections; ++i) {
      add_ambient(sum, i, fetch_irradiance(probe, ambient_direction(around_ray, i)), weight);
    }
  }
}

/// Irradiance around a ray at a point, from all volumes in order, like lookup_irradiance.
LAMBENT_FN AmbientIrradiance ambient_irradiance(int volumes, vec3 position_ws, vec3 direction_ws) {
  AmbientIrradiance sum = {vec3(0.0f), vec3(0.0f), vec3(0.0f), 0.0f};
  Frame around_ray = make_frame(direction_ws);
  for (int volume = 0; volume < volumes && sum.weight < 1.0f; ++volume) {
    ProbeGrid grid = fetch_grid(volume);
    float weight = volume_share(grid, volume, volumes, position_ws);
    if (weight <= 0.0f) continue;
    add_volume(grid, weight * (1.0f - sum.weight), position_ws, around_ray, sum);
  }
  if (sum.weight > 0.0f) {
    sum.mean /= sum.weight;
    sum.linear /= sum.weight;
    sum.quadratic /= sum.weight;
  }
  return sum;
}
