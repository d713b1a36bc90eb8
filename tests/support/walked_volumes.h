// SPDX-License-Identifier: Apache-2.0
// Volumes that overlap, turned and scrolled, which hold random light; and points in and around
// them.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "field/probes/volumes.h"
#include "support/random_store.h"

namespace lambent::test {

inline const Bounds kWalkedRoom{{-3.0f, 0.0f, -2.0f}, {3.0f, 3.0f, 2.0f}};

/// Two volumes turned any way within two cascades.
inline FieldSettings walked_settings() {
  FieldSettings settings;
  settings.cascades = 2;
  settings.probe_count = {6, 4, 5};
  settings.probe_spacing = 0.4f;
  for (const float side : {-1.0f, 1.0f}) {
    const float c = std::cos(0.4f), s = side * std::sin(0.4f);
    ProbeVolume volume;
    volume.centre = {0.7f * side, 1.1f, 0.3f};
    volume.size = {1.6f, 1.2f, 1.4f};
    volume.axes = mat3(vec3(c, 0.0f, -s), vec3(0.0f, 1.0f, 0.0f), vec3(s, 0.0f, c)) *
                  mat3(vec3(c, s, 0.0f), vec3(-s, c, 0.0f), vec3(0.0f, 0.0f, 1.0f));
    volume.probe_spacing = 0.35f;
    settings.volumes.push_back(volume);
  }
  return settings;
}

/// Their store, once the viewer has walked about. Every third probe of the second volume and every
/// second one of the last stand in solid matter.
inline ProbeStore walked_store(const FieldSettings& settings) {
  const std::vector<Volume> volumes = plan_volumes(settings, kWalkedRoom).value();
  std::vector<ProbeGrid> grids;
  for (const Volume& volume : volumes) {
    grids.push_back(volume.grid);
    if (!volume.role.follows_viewer) continue;
    for (const vec3& viewer : {vec3(1.0f, 1.0f, 1.0f), vec3(-0.7f, 1.9f, 0.8f)}) {
      grids.back() = scrolled(grids.back(), viewer);
    }
  }
  ProbeStore store(grids, settings);
  fill_randomly(store);
  const std::vector<vec2> none(
      static_cast<std::size_t>(settings.distance_texels) * settings.distance_texels, vec2(0.0f));
  const auto bury = [&](int first, int last, int step) {
    for (int probe = first; probe < last; probe += step) store.blend_moments(probe, none, 1.0f, 0u);
  };
  bury(store.grid(1).first, store.grid(2).first, 3);
  bury(store.grid(store.volumes() - 1).first, store.probes(), 2);
  return store;
}

inline std::vector<FieldQuery> walked_queries(int count) {
  RandomStream random = make_random_stream(7, 8, 9);
  std::vector<FieldQuery> queries(count);
  for (FieldQuery& query : queries) {
    const vec3 u(next_uniform2(random), next_uniform(random));
    query = {mix(kWalkedRoom.min - 0.5f, kWalkedRoom.max + 0.5f, u), random_unit(random),
             random_unit(random)};
  }
  return queries;
}

}  // namespace lambent::test
