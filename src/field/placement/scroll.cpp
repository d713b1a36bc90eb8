// SPDX-License-Identifier: Apache-2.0
// Scrolling of volumes that follow the viewer: the probes of the slab that is left behind are
// recycled for the slab that comes into range, and start from the light of the coarser volumes
// there. probes/volumes.cpp computes how far volumes scroll and which probes they recycle.
#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "field/field_state.h"
#include "field/placement/relocate.h"
#include "field/probes/tile.h"
#include "field/probes/volumes.h"
#include "lambent/world.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

constexpr std::size_t kScrolledPerTask = 16;

/// Looks the field up at the places of some probes, along the direction of every texel.
void interpolate_tiles(const ProbeData& data, const FieldBackend& backend,
                       std::span<const int> probes, std::span<const vec3> places_ws,
                       std::span<vec4> tiles) {
  const int edge = data.settings.irradiance_texels;
  const std::size_t texels = tiles.size() / max<std::size_t>(probes.size(), 1);
  parallel_chunks(probes.size(), kScrolledPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<FieldQuery> queries(texels);
    std::vector<vec3> irradiance(texels);
    std::vector<vec4> at_centres(texels);
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t t = 0; t < texels; ++t) {
        const ivec2 texel(static_cast<int>(t) % edge, static_cast<int>(t) / edge);
        const vec3 direction = tile_direction(texel, edge);
        queries[t] = {places_ws[k], direction, direction};
      }
      backend.irradiance(queries, nullptr, CorrectionUse::none, irradiance);
      for (std::size_t t = 0; t < texels; ++t) at_centres[t] = vec4(irradiance[t], 0.0f);
      data.tile_fit.apply4(&at_centres[0].x, &tiles[k * texels].x);
    }
  });
}

}  // namespace

int IrradianceField::State::scroll_volumes(const World& world, const vec3& viewer_ws,
                                           UpdateStatistics& statistics) {
  // Find the probes that are recycled, and the light at their new places
  const auto [next, recycled] =
      lambent::scroll_volumes(data.store.grids(), volumes.roles, viewer_ws, updates == 0);
  std::vector<vec3> places;
  for (const int probe : recycled) {
    const ProbeGrid& grid = next[data.store.volume_of(probe)];
    places.push_back(probe_position(grid, probe_coords(grid, probe)));
  }
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  WorkingIrradiance tiles(recycled.size() * texels);
  if (updates > 0) interpolate_tiles(data, *backend, recycled, places, tiles);

  for (int volume = 0; volume < data.store.volumes(); ++volume) {
    if (!volumes.roles[volume].follows_viewer) continue;
    data.store.move_volume(volume, next[volume]);
    volumes.grids[volume] = field_grid(next[volume]);
  }
  if (updates == 0 || recycled.empty()) return 0;

  // Move the recycled probes, with their first distances and the interpolated light
  backend->fetch_light();
  for (std::size_t k = 0; k < recycled.size(); ++k) {
    const int probe = recycled[k];
    data.store.set_probe_offset(probe, vec3(0.0f));
    reset_probe(probe, data, statuses, scheduling.scheduler);
    for (std::size_t t = 0; t < texels; ++t) {
      const vec4 held = max(tiles[k * texels + t], vec4(0.0f));
      data.light[probe * texels + t] = held;
      if (!edits.pending.before.empty()) edits.pending.before[probe * texels + t] = held;
    }
  }
  if (settings.relocation) {
    const std::vector<std::uint8_t> moving = moving_instances(world.scene());
    relocate_probes({world.scene(), tracer_of(world), data.solid_sides, moving}, recycled,
                    data.store);
  }
  initialize_relocated(world, recycled, statistics);
  for (const int probe : recycled) inherit_history(probe, world);
  backend->push_light();
  backend->store_light(recycled, dither_seed());
  return static_cast<int>(recycled.size());
}

}  // namespace lambent
