// SPDX-License-Identifier: Apache-2.0
// The variance in a probe's neighbourhood, in the common subset of C++ and GLSL. The includer
// provides
//   bool fetch_scheduled(int probe)  whether the probe may be traced and is to be compared
//   float fetch_variance(int probe)  VarianceEstimate::variance
// In C++, this file is included in the body of a struct that has these as members.

/// The mean variance of a probe and of those of its neighbours that are to be compared.
LAMBENT_FN float neighbourhood_variance(ProbeGrid grid, int probe) {
  ivec3 coords = probe_coords(grid, probe);
  float sum = fetch_variance(probe);
  int count = 1;
  for (int i = 0; i < kNeighbours; ++i) {
    int neighbour = neighbour_of(grid, coords, i);
    if (neighbour < 0) continue;
    if (!fetch_scheduled(neighbour)) continue;
    sum += fetch_variance(neighbour);
    ++count;
  }
  return sum / float(count);
}
