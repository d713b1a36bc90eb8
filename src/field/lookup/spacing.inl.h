// SPDX-License-Identifier: Apache-2.0
// The distance between probes at a point, in the common subset of C++ and GLSL. The includer
// provides
//   ProbeGrid fetch_grid(int volume)
// In C++, this file is included in the body of a struct that has it as a member.

/// Smallest spacing [m] of the first volume that takes at least half of the weight which those
/// before it leave at a point.
LAMBENT_FN float spacing_at(int volumes, vec3 position_ws) {
  int volume = 0;
  while (volume_share(fetch_grid(volume), volume, volumes, position_ws) < 0.5f) ++volume;
  return smallest_spacing(fetch_grid(volume));
}
