// SPDX-License-Identifier: Apache-2.0
// The volume that a probe belongs to.
#ifndef LAMBENT_FIELD_PROBES_SHADERS_VOLUME_OF_GLSL
#define LAMBENT_FIELD_PROBES_SHADERS_VOLUME_OF_GLSL

#include "field/vulkan/device_records.h"
#include "field/probes/shaders/tiles.glsl"

int volume_of(GridArray grids, int probe) {
  int volume = 0;
  for (int next = 1; next < kVolumes; ++next) {
    if (probe >= grids.at[next].first) volume = next;
  }
  return volume;
}

/// Where a probe stands, with its offset.
vec3 placed_position_of(GridArray grids, UintArray offsets, int probe) {
  ProbeGrid grid = grids.at[volume_of(grids, probe)];
  return placed_position(grid, probe_coords(grid, probe),
                         decode_probe_offset(offsets.at[probe]));
}

#endif
