// SPDX-License-Identifier: Apache-2.0
// Saving and loading of fields.
#include <algorithm>
#include <numeric>
#include <vector>

#include "field/field_access.h"
#include "field/field_state.h"
#include "field/file/field_file.h"
#include "field/file/field_stream.h"
#include "field/probes/tile_light.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// The factor of the weights of corrections that were learned with other light. Corrections depend
// mostly on the place, but must adapt to the new light soon.
constexpr float kOtherLightCorrections = 0.25f;

std::string size_of(const SceneIdentity& scene) {
  return std::to_string(scene.triangles) + " triangles in " + std::to_string(scene.instances) +
         " instances";
}

Expected<void> check_scene(const std::string& path, const SceneIdentity& made_for,
                           const SceneIdentity& given) {
  if (made_for.same_place(given)) return {};
  const std::string expected = size_of(made_for), seen = size_of(given);
  if (expected != seen) {
    return fail(path, "", "is of another scene: one of " + expected + ", not of " + seen);
  }
  return fail(path, "", "is of another scene: one as large, but of another shape");
}

bool same_tiles(const FieldVolume& a, const FieldVolume& b) {
  return a.irradiance_texels == b.irradiance_texels && a.distance_texels == b.distance_texels &&
         a.irradiance_format == b.irradiance_format && a.distance_format == b.distance_format;
}

}  // namespace

/// Replaces all light that the field holds.
void IrradianceField::State::restore(const FieldFile& file, const World& world,
                                     float correction_weight) {
  restore_store(file, data.store);
  data.correction.restore(file.corrections, correction_weight);
  for (int v = 0; v < data.store.volumes(); ++v) {
    const std::vector<ProbeStatus>& records = file.volumes[v].records;
    std::copy(records.begin(), records.end(), statuses.begin() + data.store.grid(v).first);
  }
  updates = static_cast<int>(file.updates);
  placement.placed_revision = world.revision();
  scheduling.scheduler.mark_all_changed();
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  double sum = 0.0;
  bool never_traced = false;
  for (int probe = 0; probe < data.store.probes(); ++probe) {
    const std::span<vec4> tile(&data.light[probe * texels], texels);
    stored_light(data.store, probe, tile);
    sum += mean_luminance(tile);
    statuses[probe].revision = world.revision();
    // An exact number of bounces is carried through all probes at once
    if (settings.max_bounces >= 0) statuses[probe].state = ProbeState::newly_vigilant;
    never_traced =
        never_traced || (is_scheduled(statuses[probe]) && statuses[probe].last_traced == 0);
  }
  scheduling.mean_light = static_cast<float>(sum / data.store.probes());
  scheduling.warming_up = updates == 0 || never_traced;
  // Compute the data that the first update computes from the scene, if that update is in the past
  if (updates == 0) return;
  std::vector<int> all(statuses.size());
  std::iota(all.begin(), all.end(), 0);
  find_solid_sides(world);
  update_classification_inputs(world, all);
  update_cell_visibility(world, all);
}

/// A volume as a file stores it: with its probes in the order of the grid, regardless of scrolling.
FieldVolume IrradianceField::State::volume_for_file(int volume, const World& world) const {
  FieldVolume result;
  result.grid = data.store.grid(volume);
  result.role = volumes.roles[volume];
  result.irradiance_texels = data.store.irradiance_texels();
  result.distance_texels = data.store.distance_texels();
  result.irradiance_format = data.store.irradiance_format();
  result.distance_format = data.store.distance_format();
  const ProbeGrid& stored = data.store.grid(volume);
  result.grid.scroll = ivec3(0);
  result.grid.first = 0;
  const std::size_t irradiance_tile = data.store.irradiance_words().size() / data.store.probes();
  const std::size_t distance_tile = data.store.distance_words().size() / data.store.probes();
  for (int i = 0; i < probe_count(stored); ++i) {
    const int probe = probe_index(stored, probe_coords(result.grid, i));
    ProbeStatus& status = result.records.emplace_back(statuses[probe]);
    // The average of a stale probe is of light before an edit
    if (status.revision != world.revision()) status.samples = 0.0f;
    result.offsets.push_back(data.store.offset_words()[probe]);
    const auto irradiance =
        data.store.irradiance_words().subspan(probe * irradiance_tile, irradiance_tile);
    const auto distance = data.store.distance_words().subspan(probe * distance_tile, distance_tile);
    result.irradiance.insert(result.irradiance.end(), irradiance.begin(), irradiance.end());
    result.distance.insert(result.distance.end(), distance.begin(), distance.end());
  }
  return result;
}

FieldFile IrradianceField::State::for_file(const World& world) const {
  FieldFile file;
  file.updates = static_cast<std::uint32_t>(updates);
  file.scene = identify(world.scene(), settings);
  for (int volume = 0; volume < data.store.volumes(); ++volume) {
    file.volumes.push_back(volume_for_file(volume, world));
  }
  return file;
}

Expected<void> save_field(const std::string& path, const IrradianceField& field,
                          const World& world) {
  const FieldAccess::State& state = FieldAccess::state_of(field);
  state.backend->fetch_store();
  state.backend->fetch_corrections();
  Ranks& ranks = state.data.share.ranks();
  const FieldFile file = ranks.own() == 0 ? state.for_file(world) : FieldFile{};
  return write_shared_field(path, {}, file, state.data.correction, ranks);
}

Expected<LoadedField> load_field(const std::string& path, const FieldSettings& settings,
                                 const World& world) {
  Expected<FieldFile> file = read_field_file(path);
  if (!file) return tl::unexpected(file.error());
  const SceneIdentity scene = identify(world.scene(), settings);
  if (const auto fine = check_scene(path, file->scene, scene); !fine) {
    return tl::unexpected(fine.error());
  }
  const FieldVolume& last = file->volumes.back();
  std::vector<Volume> volumes;
  for (const FieldVolume& volume : file->volumes) {
    if (!same_tiles(volume, last)) return fail(path, "", "has volumes whose tiles differ");
    volumes.push_back({volume.grid, volume.role});
  }
  const FieldSettings merged = last.store_settings(settings);
  if (const Expected<void> fine = check_settings(merged); !fine) {
    return tl::unexpected(fine.error());
  }
  if (const auto planned = plan_volumes(merged, {}); !planned) {
    return tl::unexpected(planned.error());
  }
  // Use exactly the grids of the file
  auto state = std::make_unique<FieldAccess::State>(merged, volumes);

  const bool same_light = file->scene.light == scene.light;
  if (!same_light) {
    // Updates start from the light of the file, but do not average it with the new light
    for (FieldVolume& volume : file->volumes) {
      for (ProbeStatus& status : volume.records) status.samples = 0.0f;
    }
  }
  state->restore(*file, world, same_light ? 1.0f : kOtherLightCorrections);
  return LoadedField{FieldAccess::make(std::move(state)), same_light};
}

}  // namespace lambent
