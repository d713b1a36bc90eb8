// SPDX-License-Identifier: Apache-2.0
// The noise of a probe's neighbourhood. The twin of ProbeScheduler::refresh_noise.
#ifndef LAMBENT_FIELD_SCHEDULE_SHADERS_NOISE_AROUND_GLSL
#define LAMBENT_FIELD_SCHEDULE_SHADERS_NOISE_AROUND_GLSL

#include "field/schedule/schedule_arguments.h"
#include "field/probes/shaders/volume_of.glsl"

/// The mean noise of a probe and of its neighbours along the axes that are not off.
float noise_around(GridArray grids, UintArray states, ServiceArray service, int probe) {
  ProbeGrid grid = grids.at[volume_of(grids, probe)];
  ivec3 place = probe_coords(grid, probe);
  float sum = service.at[probe].known.noise;
  int count = 1;
  for (int i = 0; i < 6; ++i) {
    ivec3 next = place;
    next[i / 2] += 2 * (i % 2) - 1;
    if (next[i / 2] < 0 || next[i / 2] >= grid.count[i / 2]) continue;
    int neighbour = probe_index(grid, next);
    if (states.at[neighbour] == kProbeOff) continue;
    sum += service.at[neighbour].known.noise;
    ++count;
  }
  return sum / float(count);
}

#endif
