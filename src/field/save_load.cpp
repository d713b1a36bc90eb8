// SPDX-License-Identifier: Apache-2.0
// Fields to and from files.
#include <numeric>
#include <vector>

#include "core/atomic_file.h"
#include "field/field_file.h"
#include "field/field_state.h"
#include "field/tile_light.h"
#include "lambent/world.h"

namespace lambent {
namespace {

std::string size_of(const SceneIdentity& scene) {
  return std::to_string(scene.triangles) + " triangles in " + std::to_string(scene.instances) +
         " instances";
}

Expected<void> check_scene(const std::string& path, const SceneIdentity& made_for,
                           const SceneIdentity& given) {
  if (made_for.same_place(given)) return {};
  const std::string told = size_of(made_for), seen = size_of(given);
  if (told != seen) {
    return fail(path, "", "is of another scene: one of " + told + ", not of " + seen);
  }
  return fail(path, "", "is of another scene: one as large, but of another shape");
}

}  // namespace

/// Takes the place of all light that the field holds.
void IrradianceField::State::restore(const FieldVolume& volume, std::uint32_t updates_so_far,
                                     const World& world) {
  store.restore(volume.offsets, volume.irradiance, volume.distance);
  records = volume.records;
  updates = static_cast<int>(updates_so_far);
  starting = updates == 0;
  agenda.changed_all();
  const int n = settings.irradiance_texels;
  const auto texels = static_cast<std::size_t>(tile_texels());
  double sum = 0.0;
  for (int probe = 0; probe < store.probes(); ++probe) {
    vec4* tile = &light[probe * texels];
    for (int t = 0; t < n * n; ++t) {
      tile[t] = vec4(store.irradiance_texel(probe, ivec2(t % n, t / n) + 1), 0.0f);
    }
    sum += mean_luminance(TileLight(tile, texels));
    records[probe].revision = world.revision();
  }
  mean_light = static_cast<float>(sum / store.probes());
  // What the first update finds of the scene, where that has been
  if (updates == 0) return;
  std::vector<int> all(records.size());
  std::iota(all.begin(), all.end(), 0);
  find_reaches(world, all);
  if (settings.visibility == Visibility::hybrid) sights.look(world.tracer(), store, all);
}

Expected<void> save_field(const std::string& path, const IrradianceField& field,
                          const World& world) {
  const IrradianceField::State& state = *field.state_;
  const ProbeStore& store = state.store;
  FieldFile file;
  file.updates = static_cast<std::uint32_t>(state.updates);
  file.scene = identify(world.scene(), state.settings);
  FieldVolume& volume = file.volumes.emplace_back();
  volume.grid = state.grid;
  volume.irradiance_texels = store.irradiance_texels();
  volume.distance_texels = store.distance_texels();
  volume.irradiance_format = store.irradiance_format();
  volume.distance_format = store.distance_format();
  volume.records = state.records;
  for (ProbeRecord& record : volume.records) {
    // What waits to follow an edit has averaged another light than the world's
    if (record.revision != world.revision()) record.samples = 0.0f;
  }
  volume.offsets.assign(store.offset_words().begin(), store.offset_words().end());
  volume.irradiance.assign(store.irradiance_words().begin(), store.irradiance_words().end());
  volume.distance.assign(store.distance_words().begin(), store.distance_words().end());
  return write_file_atomically(path, encode_field(file));
}

Expected<LoadedField> load_field(const std::string& path, const FieldSettings& settings,
                                 const World& world) {
  Expected<FieldFile> file = read_field_file(path);
  if (!file) return tl::unexpected(file.error());
  const SceneIdentity scene = identify(world.scene(), settings);
  if (const auto fine = check_scene(path, file->scene, scene); !fine) {
    return tl::unexpected(fine.error());
  }
  if (file->volumes.size() != 1) {
    return fail(path, "",
                "holds " + std::to_string(file->volumes.size()) + " volumes; a field has one");
  }
  FieldVolume& volume = file->volumes.front();
  const FieldSettings merged = volume.store_settings(settings);
  Expected<IrradianceField> field = IrradianceField::make(merged, {});
  if (!field) return tl::unexpected(field.error());
  // The very grid, to the bit
  field->state_ = std::make_unique<IrradianceField::State>(merged, volume.grid);

  const bool same_light = file->scene.light == scene.light;
  if (!same_light) {
    // What it holds is where to start from, but no average of what is to be found
    for (ProbeRecord& record : volume.records) record.samples = 0.0f;
  }
  field->state_->restore(volume, file->updates, world);
  return LoadedField{std::move(*field), same_light};
}

}  // namespace lambent
