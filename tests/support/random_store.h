// SPDX-License-Identifier: Apache-2.0
// Stores of random light, and the lookup that CPU and GPU share over them.
#pragma once

#include <vector>

#include "field/lookup/lookup.h"
#include "field/probes/probe_store.h"
#include "shared/constants.h"
#include "shared/random.h"

namespace lambent::test {

/// The lookup that CPU and GPU share, over a store.
struct SharedLookup {
  const ProbeStore& store;

  ProbeGrid fetch_grid(int volume) { return store.grid(volume); }
  vec2 fetch_moments(int probe, vec3 direction) {
    const float unit = distance_unit(store.grid_of(probe));
    return store.moments(probe, direction) / vec2(unit, unit * unit);
  }
  vec3 fetch_offset(int probe) { return store.probe_offset(probe); }
  vec3 fetch_irradiance(int probe, vec3 direction) { return store.irradiance(probe, direction); }
  float fetch_correction(const ProbeGrid&, int, vec3, vec3) { return 1.0f; }
#include "field/lookup/lookup.inl.h"
};

inline vec3 random_unit(RandomStream& random) {
  const vec2 u = next_uniform2(random);
  const float z = 2.0f * u.x - 1.0f, radius = sqrt(max(0.0f, 1.0f - z * z));
  return {radius * cos(kTwoPi * u.y), radius * sin(kTwoPi * u.y), z};
}

/// Has probes stand off the grid, hold random light and see random distances, of which the mean
/// square is at least the mean's square.
inline void fill_randomly(ProbeStore& store) {
  RandomStream random = make_random_stream(11, 22, 33);
  std::vector<vec3> irradiance(store.irradiance_texels() * store.irradiance_texels());
  std::vector<vec2> moments(store.distance_texels() * store.distance_texels());
  for (int probe = 0; probe < store.probes(); ++probe) {
    for (vec3& texel : irradiance) texel = 5.0f * vec3(next_uniform2(random), next_uniform(random));
    for (vec2& texel : moments) {
      const float mean = 1.5f * next_uniform(random);
      texel = {mean, mean * mean * (1.05f + next_uniform(random))};
    }
    store.store_irradiance(probe, irradiance, 1u);
    store.blend_moments(probe, moments, 1.0f, 1u);
    const vec3 offset(next_uniform2(random), next_uniform(random));
    store.set_probe_offset(probe, kMaxProbeOffset * (2.0f * offset - 1.0f));
  }
}

}  // namespace lambent::test
