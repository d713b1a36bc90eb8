// SPDX-License-Identifier: Apache-2.0
#include "bake/checkpoint.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <vector>

#include "core/checksum.h"
#include "core/files/file_bytes.h"
#include "core/little_endian.h"
#include "field/field_access.h"
#include "field/field_state.h"
#include "field/file/field_file.h"
#include "field/file/field_stream.h"
#include "lambent/lambent.h"

namespace lambent {
namespace {

constexpr std::array<char, 8> kMagic = {'L', 'A', 'M', 'B', 'E', 'N', 'T', 'C'};
constexpr std::uint32_t kCheckpointVersion = 1;
// Magic, version, checksum, identity, mean light, whether it is warming up, number of texels.
constexpr std::size_t kHeaderBytes = 8 + 6 * sizeof(std::uint32_t);
constexpr std::size_t kChecksumPlace = 12;
constexpr std::size_t kCheckedFrom = 16;
// Largest file that is read: a field with the most probes, in the largest formats.
constexpr std::uint64_t kMaxCheckpointBytes = std::uint64_t{24} << 30;
// Largest valid light [W/m^2].
constexpr float kMaxLight = 1e18f;

using State = FieldAccess::State;

void add_vec3(const vec3& v, ByteWriter& out) {
  for (int axis = 0; axis < 3; ++axis) out.f32(v[axis]);
}

/// Adds all settings except the additional volumes, whose grids are added elsewhere.
void add_settings(const FieldSettings& settings, ByteWriter& out) {
  // A new setting causes a compile error here
  const auto& [probe_count, probe_spacing, probe_budget, volume, cascades, volumes, rays_per_probe,
               hysteresis, irradiance_texels, distance_texels, irradiance_format, distance_format,
               relocation, corrections, visibility, solve_tolerance, max_solve_iterations,
               max_bounces, max_albedo, emissive_samples, texture_lod_bias, seed] = settings;
  for (const int number :
       {probe_count.x, probe_count.y, probe_count.z, probe_budget, cascades, rays_per_probe,
        irradiance_texels, distance_texels, static_cast<int>(irradiance_format),
        static_cast<int>(distance_format), relocation ? 1 : 0, corrections ? 1 : 0,
        static_cast<int>(visibility), max_solve_iterations, max_bounces, emissive_samples}) {
    out.i32(number);
  }
  for (const float number :
       {probe_spacing, hysteresis, solve_tolerance, max_albedo, texture_lod_bias}) {
    out.f32(number);
  }
  out.u32(seed);
  out.u32(static_cast<std::uint32_t>(volumes.size()));
  add_vec3(volume.min, out);
  add_vec3(volume.max, out);
}

void add_grid(const ProbeGrid& grid, ByteWriter& out) {
  add_vec3(grid.origin_ws, out);
  add_vec3(grid.spacing, out);
  for (int axis = 0; axis < 3; ++axis) out.i32(grid.count[axis]);
  for (int axis = 0; axis < 3; ++axis) add_vec3(grid.axes[axis], out);
}

/// A checksum of everything on which the bits of a bake depend. Grids are those of a field without
/// updates: they represent the scene's bounds and the additional volumes of the settings.
std::uint32_t identity_of(const World& world, const State& state,
                          const std::optional<vec3>& viewer_ws) {
  ByteWriter out;
  for (const int number : {LAMBENT_VERSION_MAJOR, LAMBENT_VERSION_MINOR, LAMBENT_VERSION_PATCH}) {
    out.i32(number);
  }
  const SceneIdentity scene = identify(world.scene(), state.settings);
  for (const std::uint64_t number : {scene.triangles, scene.vertices}) out.u64(number);
  for (const std::uint32_t number : {scene.instances, scene.geometry, scene.light}) out.u32(number);
  add_settings(state.settings, out);
  for (int volume = 0; volume < state.data.store.volumes(); ++volume) {
    ProbeGrid grid = state.data.store.grid(volume);
    // The place of volumes that follow the viewer depends only on the viewer, which is added
    // separately
    if (state.volumes.roles[volume].follows_viewer) grid.origin_ws = vec3(0.0f);
    add_grid(grid, out);
  }
  out.u32(viewer_ws ? 1 : 0);
  if (viewer_ws) add_vec3(*viewer_ws, out);
  return crc32_of(out.bytes());
}

/// Encodes the header before the field file.
std::vector<std::byte> encode_front(const State& state, std::uint32_t identity) {
  ByteWriter out;
  out.raw(std::as_bytes(std::span(kMagic)));
  out.u32(kCheckpointVersion);
  out.u32(0);  // replaced below
  out.u32(identity);
  out.f32(state.scheduling.mean_light);
  out.u32(state.scheduling.warming_up ? 1 : 0);
  out.u32(static_cast<std::uint32_t>(state.data.light.size()));
  for (const vec4& texel : state.data.light) add_vec3(vec3(texel), out);
  out.u32_at(kChecksumPlace, crc32_of(out.bytes().subspan(kCheckedFrom)));
  return out.take();
}

bool is_light(float value) {
  return value >= 0.0f && value <= kMaxLight;
}

Expected<Checkpoint> decode(const std::string& path, std::span<const std::byte> bytes,
                            std::uint32_t identity, std::size_t texels) {
  const std::span<const std::byte> magic = std::as_bytes(std::span(kMagic));
  if (bytes.size() < magic.size() || !std::equal(magic.begin(), magic.end(), bytes.begin())) {
    return fail(path, "", "is not a checkpoint");
  }
  if (bytes.size() < kHeaderBytes) return fail(path, "", "is cut short");
  ByteReader in(bytes.subspan(magic.size()));
  if (const std::uint32_t version = in.u32(); version != kCheckpointVersion) {
    return fail(path, "",
                "is of version " + std::to_string(version) + "; version " +
                    std::to_string(kCheckpointVersion) + " can be read");
  }
  const std::uint32_t checksum = in.u32();
  if (in.u32() != identity) {
    return fail(path, "",
                "is of another bake: of another scene, view, version, or other options; without "
                "it, the bake starts anew");
  }
  Checkpoint checkpoint;
  checkpoint.mean_light = in.f32();
  checkpoint.warming_up = in.u32() != 0;
  const std::size_t light_bytes = 3 * sizeof(float) * texels;
  if (in.u32() != texels || in.left() < light_bytes) {
    return fail(path, "", "has a size that does not fit its probes");
  }
  const std::size_t front = kHeaderBytes + light_bytes;
  if (checksum != crc32_of(bytes.subspan(kCheckedFrom, front - kCheckedFrom))) {
    return fail(path, "", "is broken: its checksum does not match what it holds");
  }
  checkpoint.light.resize(3 * texels);
  for (float& value : checkpoint.light) value = in.f32();
  if (!is_light(checkpoint.mean_light) ||
      !std::all_of(checkpoint.light.begin(), checkpoint.light.end(), is_light)) {
    return fail(path, "", "holds light that is not within 0 to 1e18");
  }
  Expected<FieldFile> field = decode_field(path, bytes.subspan(front));
  if (!field) return tl::unexpected(field.error());
  checkpoint.field = std::move(*field);
  return checkpoint;
}

/// Whether a volume has as many probes and texels as the field's. Its place is part of the
/// identity.
bool is_of_grid(const FieldVolume& volume, const ProbeGrid& grid, const FieldSettings& settings) {
  return volume.grid.count == grid.count &&
         volume.irradiance_texels == settings.irradiance_texels &&
         volume.distance_texels == settings.distance_texels &&
         volume.irradiance_format == settings.irradiance_format &&
         volume.distance_format == settings.distance_format;
}

/// Restores the probes of a volume, which files store in the order of its grid.
void restore_volume(const FieldVolume& volume, const ProbeGrid& grid, std::uint64_t revision,
                    State& state) {
  const std::size_t irradiance = volume.irradiance.size() / volume.records.size();
  const std::size_t distance = volume.distance.size() / volume.records.size();
  for (std::size_t i = 0; i < volume.records.size(); ++i) {
    const int probe = probe_index(grid, probe_coords(volume.grid, static_cast<int>(i)));
    state.data.store.restore(probe, std::span(volume.offsets).subspan(i, 1),
                             std::span(volume.irradiance).subspan(i * irradiance, irradiance),
                             std::span(volume.distance).subspan(i * distance, distance));
    state.statuses[probe] = volume.records[i];
    state.statuses[probe].revision = revision;
  }
}

}  // namespace

Expected<void> save_checkpoint(const std::string& path, const IrradianceField& field,
                               const World& world, const std::optional<glm::vec3>& viewer_ws) {
  const State& state = FieldAccess::state_of(field);
  assert(state.updates > 0);
  Ranks& ranks = state.data.share.ranks();
  std::vector<std::byte> front;
  FieldFile file;
  if (ranks.own() == 0) {
    front = encode_front(state, identity_of(world, state, viewer_ws));
    file = state.for_file(world);
  }
  return write_shared_field(path, front, file, state.data.correction, ranks);
}

std::uint32_t bake_identity(const IrradianceField& field, const World& world,
                            const std::optional<glm::vec3>& viewer_ws) {
  return identity_of(world, FieldAccess::state_of(field), viewer_ws);
}

Expected<Checkpoint> read_checkpoint(const std::string& path, const World& world,
                                     const std::optional<glm::vec3>& viewer_ws,
                                     const IrradianceField& field) {
  const State& state = FieldAccess::state_of(field);
  assert(state.updates == 0);
  const Expected<std::vector<std::byte>> bytes = read_file(path, kMaxCheckpointBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  Expected<Checkpoint> read =
      decode(path, *bytes, identity_of(world, state, viewer_ws), state.data.light.size());
  if (!read) return read;
  const std::vector<FieldVolume>& volumes = read->field.volumes;
  if (volumes.size() != static_cast<std::size_t>(state.data.store.volumes()) ||
      read->field.updates == 0) {
    return fail(path, "", "has volumes that are not the field's");
  }
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    if (!is_of_grid(volumes[v], state.data.store.grid(static_cast<int>(v)), state.settings)) {
      return fail(path, "volume " + std::to_string(v), "is not the field's");
    }
  }
  return read;
}

void resume_from(const Checkpoint& checkpoint, const World& world,
                 const std::optional<glm::vec3>& viewer_ws, IrradianceField& field) {
  State& state = FieldAccess::state_of(field);
  assert(state.updates == 0);
  // Do the same as the first update before it traces
  state.find_solid_sides(world);
  UpdateStatistics statistics;
  if (viewer_ws) state.scroll_volumes(world, *viewer_ws, statistics);

  const FieldFile& file = checkpoint.field;
  for (int v = 0; v < state.data.store.volumes(); ++v) {
    restore_volume(file.volumes[v], state.data.store.grid(v), world.revision(), state);
  }
  for (std::size_t t = 0; t < state.data.light.size(); ++t) {
    const float* light = &checkpoint.light[3 * t];
    state.data.light[t] = vec4(light[0], light[1], light[2], 0.0f);
  }
  state.data.correction.restore(file.corrections, 1.0f);
  state.updates = static_cast<int>(file.updates);
  state.scheduling.mean_light = checkpoint.mean_light;
  state.scheduling.warming_up = checkpoint.warming_up;
  state.scheduling.scheduler.mark_all_changed();
  state.placement.placed_revision = world.revision();
  state.update_classification_inputs(world, state.all_probes());
  state.update_cell_visibility(world, state.all_probes());
}

}  // namespace lambent
