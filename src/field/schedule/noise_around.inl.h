// SPDX-License-Identifier: Apache-2.0
// The noise of a probe's neighbourhood, in the common subset of C++ and GLSL. The includer provides
//   bool fetch_live(int probe)    whether the probe may be traced
//   float fetch_noise(int probe)  KnownNoise::noise
// In C++, this file is included in the body of a struct that has these as members.

/// The mean noise of a probe and of those of its neighbours that are live.
LAMBENT_FN float noise_around(ProbeGrid grid, int probe) {
  ivec3 coords = probe_coords(grid, probe);
  float sum = fetch_noise(probe);
  int count = 1;
  for (int i = 0; i < kNeighbours; ++i) {
    int neighbour = neighbour_of(grid, coords, i);
    if (neighbour < 0) continue;
    if (!fetch_live(neighbour)) continue;
    sum += fetch_noise(neighbour);
    ++count;
  }
  return sum / float(count);
}
