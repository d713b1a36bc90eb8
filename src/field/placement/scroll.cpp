// SPDX-License-Identifier: Apache-2.0
// Scrolling of volumes that follow the viewer: the probes of the slab that is left behind are
// recycled for the slab that comes into range, and start from the light that the coarser volumes
// hold there.
#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "field/field_state.h"
#include "field/lookup/lookup_volumes.h"
#include "field/placement/relocate.h"
#include "field/probes/tile.h"
#include "field/probes/volumes.h"
#include "lambent/world.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;

}  // namespace

/// Looks the field up at the places of some probes, along the direction of every texel.
void IrradianceField::State::interpolate_tiles(std::span<const int> probes,
                                               std::span<const vec3> places_ws,
                                               std::span<vec4> tiles) const {
  const int edge = settings.irradiance_texels;
  const std::size_t texels = tiles.size() / max<std::size_t>(probes.size(), 1);
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<FieldQuery> queries(texels);
    std::vector<vec3> irradiance(texels);
    std::vector<vec4> at_centres(texels);
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t t = 0; t < texels; ++t) {
        const ivec2 texel(static_cast<int>(t) % edge, static_cast<int>(t) / edge);
        const vec3 direction = tile_direction(texel, edge);
        queries[t] = {places_ws[k], direction, direction};
      }
      if (device) {
        device->irradiance(queries, nullptr, irradiance);
      } else {
        lookup_irradiance(store, {}, queries, irradiance);
      }
      for (std::size_t t = 0; t < texels; ++t) at_centres[t] = vec4(irradiance[t], 0.0f);
      tile_fit.apply4(&at_centres[0].x, &tiles[k * texels].x);
    }
  });
}

int IrradianceField::State::scroll_volumes(const World& world, const vec3& viewer_ws,
                                           UpdateStatistics& statistics) {
  // Find the probes that are recycled, and the light at their new places
  std::vector<int> recycled;
  std::vector<vec3> places;
  std::vector<ProbeGrid> next(store.grids().begin(), store.grids().end());
  for (int volume = 0; volume < store.volumes(); ++volume) {
    if (!roles[volume].follows_viewer) continue;
    const ProbeGrid& grid = store.grid(volume);
    next[volume] = updates == 0 ? centred(grid, viewer_ws) : scrolled(grid, viewer_ws);
    const std::vector<int> probes = recycled_probes(store.grid(volume), next[volume]);
    for (const int probe : probes) {
      places.push_back(probe_position(next[volume], probe_coords(next[volume], probe)));
    }
    recycled.insert(recycled.end(), probes.begin(), probes.end());
  }
  const auto texels = static_cast<std::size_t>(tile_texels());
  WorkingIrradiance tiles(recycled.size() * texels);
  if (updates > 0) interpolate_tiles(recycled, places, tiles);

  for (int volume = 0; volume < store.volumes(); ++volume) {
    if (!roles[volume].follows_viewer) continue;
    store.move_volume(volume, next[volume]);
    grids[volume] = field_grid(next[volume]);
  }
  if (updates == 0 || recycled.empty()) return 0;

  // Move the recycled probes, with their first distances and the interpolated light
  fetch_light();
  for (std::size_t k = 0; k < recycled.size(); ++k) {
    const int probe = recycled[k];
    store.set_probe_offset(probe, vec3(0.0f));
    reset_probe(probe);
    for (std::size_t t = 0; t < texels; ++t) {
      const vec4 held = max(tiles[k * texels + t], vec4(0.0f));
      light[probe * texels + t] = held;
      if (!pending_edits.before.empty()) pending_edits.before[probe * texels + t] = held;
    }
  }
  if (settings.relocation) {
    relocate_probes(world.scene(), world.tracer(), recycled, moving_instances(world.scene()),
                    store);
  }
  initialize_relocated(world, recycled, statistics);
  for (const int probe : recycled) inherit_history(probe, world);
  if (device) device->write_light(light, last_irradiance_estimate);
  store_light(recycled);
  return static_cast<int>(recycled.size());
}

}  // namespace lambent
