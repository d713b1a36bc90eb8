// SPDX-License-Identifier: Apache-2.0
// The volume that a probe is of.
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

#endif
