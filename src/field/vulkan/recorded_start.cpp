// SPDX-License-Identifier: Apache-2.0
// The start of a recorded field from a field file.
#include <algorithm>

#include "field/file/field_file.h"
#include "field/probes/tile_light.h"
#include "field/schedule/schedule.h"
#include "field/vulkan/recorded_state.h"

namespace lambent::vulkan {
namespace {

// The largest difference between a file's volume and the planned one [cells]. Engines and baking
// programs round the bounds of a scene differently.
constexpr float kPlaceSlack = 1e-3f;

std::string size_of(const ivec3& count) {
  return std::to_string(count.x) + " x " + std::to_string(count.y) + " x " +
         std::to_string(count.z);
}

/// Describes how a file's tiles differ from those that the settings request; empty: not at all.
std::string misfit_of_tiles(const FieldVolume& volume, const FieldSettings& settings) {
  if (volume.irradiance_format != settings.irradiance_format) {
    return "stores irradiance in another format than the settings ask for";
  }
  if (volume.distance_format != settings.distance_format) {
    return "stores distances in another format than the settings ask for";
  }
  const auto texels = [](const char* what, int has, int asked) {
    return "has " + std::string(what) + " tiles of " + std::to_string(has) +
           " texels along an edge, not of " + std::to_string(asked) + " as the settings ask for";
  };
  if (volume.irradiance_texels != settings.irradiance_texels) {
    return texels("irradiance", volume.irradiance_texels, settings.irradiance_texels);
  }
  if (volume.distance_texels != settings.distance_texels) {
    return texels("distance", volume.distance_texels, settings.distance_texels);
  }
  return "";
}

/// Whether both grids have their probes at the same places relative to probe 0.
bool same_shape(const ProbeGrid& a, const ProbeGrid& b) {
  const vec3 cells = vec3(a.count - 1);
  for (int axis = 0; axis < 3; ++axis) {
    const vec3 far_off =
        cells[axis] * (a.axes[axis] * a.spacing[axis] - b.axes[axis] * b.spacing[axis]);
    if (!(length(far_off) <= kPlaceSlack * smallest_spacing(b))) return false;
  }
  return true;
}

/// Describes how a file's volume differs from the planned one; empty: not at all.
std::string misfit_of_place(const FieldVolume& volume, const ProbeGrid& planned,
                            const VolumeRole& role) {
  const ProbeGrid& grid = volume.grid;
  if (volume.role.follows_viewer != role.follows_viewer) {
    return role.follows_viewer ? "does not follow the viewer, as the planned cascade does"
                               : "is a cascade, where none is planned";
  }
  if (volume.role.level != role.level) {
    return "is of cascade level " + std::to_string(volume.role.level) + ", not " +
           std::to_string(role.level);
  }
  if (grid.count != planned.count) {
    return "has " + size_of(grid.count) + " probes, not " + size_of(planned.count) + " as planned";
  }
  if (!same_shape(grid, planned)) return "has another spacing or other axes than planned";
  const float apart = length(grid.origin_ws - planned.origin_ws);
  if (!role.follows_viewer && !(apart <= kPlaceSlack * smallest_spacing(planned))) {
    return "stands elsewhere than planned";
  }
  return "";
}

/// The RecordedProbe of a probe of a file. Its placement is over.
RecordedProbe standing_of(const ProbeStatus& status, uint offset, float longest, uint placed) {
  RecordedProbe standing{};
  standing.samples = std::min(status.samples, longest);
  standing.offset = offset;
  standing.relocation = begin_relocation(decode_probe_offset(offset));
  standing.relocation.converged = 1u;
  standing.placed = placed;
  standing.coarse = 1u;
  return standing;
}

}  // namespace

Expected<void> RecordedField::State::check_fit(const std::string& path,
                                               const FieldFile& file) const {
  if (file.volumes.size() != grids.size()) {
    return fail(path, "",
                "has " + std::to_string(file.volumes.size()) + " volumes, not " +
                    std::to_string(grids.size()) + " as planned");
  }
  for (std::size_t v = 0; v < grids.size(); ++v) {
    std::string misfit = misfit_of_tiles(file.volumes[v], settings);
    if (misfit.empty()) misfit = misfit_of_place(file.volumes[v], grids[v], roles[v]);
    if (!misfit.empty()) return fail(path, "volume " + std::to_string(v), misfit);
  }
  return {};
}

void RecordedField::State::restore(const FieldFile& file) {
  grids.clear();
  std::vector<ProbeStatus> statuses;
  for (const FieldVolume& volume : file.volumes) {
    grids.push_back(volume.grid);
    statuses.insert(statuses.end(), volume.records.begin(), volume.records.end());
  }
  ProbeStore store(grids, settings);
  restore_store(file, store);
  grids.assign(store.grids().begin(), store.grids().end());

  const float longest = longest_average(settings);
  const auto texels = static_cast<std::size_t>(field.tile_texels());
  std::vector<vec4> light(statuses.size() * texels);
  std::vector<RecordedProbe> stands;
  std::vector<uint> switched;
  std::vector<ProbeVariability> variability;
  double sum = 0.0;
  for (std::size_t probe = 0; probe < statuses.size(); ++probe) {
    const ProbeStatus& status = statuses[probe];
    const std::span<vec4> tile(&light[probe * texels], texels);
    stored_light(store, static_cast<int>(probe), tile);
    sum += mean_luminance(tile);
    stands.push_back(standing_of(status, store.offset_words()[probe], longest, placing_updates));
    switched.push_back(status.state == ProbeState::off ? kProbeOff : kProbeOn);
    variability.push_back({{status.variance, status.variance_samples}, status.last_traced});
  }
  CorrectionTable corrections(store.probes());
  corrections.restore(file.corrections, 1.0f);
  field.corrections().write(corrections);
  write_record();
  field.write_store(store);
  vulkan::write<vec4>(*device, light, field.light());
  vulkan::write<RecordedProbe>(*device, stands, standing);
  vulkan::write<uint>(*device, switched, states);
  if (schedule) {
    schedule->start_from(variability,
                         static_cast<float>(sum / static_cast<double>(statuses.size())));
  }
  plan.start_from(file.updates, statuses);
}

Expected<void> RecordedField::start_from(const std::string& path) {
  State& s = *state_;
  if (s.plan.updates() > 0) return fail(path, "", "comes too late: the field holds light already");
  const Expected<FieldFile> file = read_field_file(path);
  if (!file) return tl::unexpected(file.error());
  if (const auto fits = s.check_fit(path, *file); !fits) return fits;
  // A field that was saved before its first update has learned nothing
  if (file->updates > 0) s.restore(*file);
  return {};
}

}  // namespace lambent::vulkan
