// SPDX-License-Identifier: Apache-2.0
// The reader does not trust files: it checks sizes against the number of bytes before it allocates
// memory, and numbers against the ranges that a field allows.
#include <algorithm>
#include <cmath>

#include "core/checksum.h"
#include "core/files/file_bytes.h"
#include "core/little_endian.h"
#include "field/file/field_file.h"
#include "field/file/layout.h"

namespace lambent {
namespace {

// The largest file that is read: a field of the most probes, in the largest formats, takes less.
constexpr std::uint64_t kMaxFieldFileBytes = std::uint64_t{16} << 30;

// The largest number of updates: half a year at 60 Hz, and far from an overflow.
constexpr std::uint32_t kMaxUpdates = 1u << 30u;

constexpr auto kStates = static_cast<std::uint32_t>(ProbeState::vigilant) + 1;

/// The checked header of a volume.
struct VolumeHeader {
  std::uint64_t bytes = 0;
  FieldVolume volume;  // without its probes
  std::uint64_t probes = 0, irradiance_words = 0, distance_words = 0;
};

vec3 read_vec3(ByteReader& in) {
  vec3 v;
  for (int axis = 0; axis < 3; ++axis) v[axis] = in.f32();
  return v;
}

// The largest valid stored number: light is below 1e14 W/m^2 (that of the brightest sky, after all
// bounces), and the square of a mean distance must be a float.
constexpr float kMaxStored = 1e18f;

// Written so that NaN fails.
bool all_storable(std::span<const uint> words) {
  return std::all_of(words.begin(), words.end(),
                     [](uint word) { return std::abs(uintBitsToFloat(word)) <= kMaxStored; });
}

bool is_sum(float value) {
  return value >= 0.0f && value <= kMaxStored;
}

class Reader {
 public:
  Reader(const std::string& name, std::span<const std::byte> bytes)
      : name_(name), bytes_(bytes), in_(bytes) {}

  Expected<FieldFile> read() {
    if (auto fine = check_container(); !fine) return tl::unexpected(fine.error());
    FieldFile field;
    const std::uint32_t volumes = in_.u32();
    if (volumes < 1 || volumes > kMaxVolumes) {
      return bad("header", "has " + std::to_string(volumes) + " volumes");
    }
    field.updates = in_.u32();
    if (field.updates > kMaxUpdates)
      return bad("header", "has had more updates than can be counted");
    field.scene.triangles = in_.u64();
    field.scene.vertices = in_.u64();
    field.scene.instances = in_.u32();
    field.scene.geometry = in_.u32();
    field.scene.light = in_.u32();
    if (in_.u32() != kHeaderBytes) return bad("header", "is not of 64 bytes");
    std::size_t probes = 0;
    for (std::uint32_t i = 0; i < volumes; ++i) {
      place_ = "volume " + std::to_string(i);
      Expected<FieldVolume> volume = read_volume(field.updates);
      if (!volume) return tl::unexpected(volume.error());
      field.volumes.push_back(std::move(*volume));
      probes += field.volumes.back().records.size();
    }
    if (probes > kMaxProbes) return bad("", "has more probes than a field can");
    if (auto fine = read_corrections(volumes, field.corrections); !fine) {
      return tl::unexpected(fine.error());
    }
    return field;
  }

 private:
  tl::unexpected<Error> bad(const std::string& place, const std::string& cause) const {
    return fail(name_, place, cause);
  }

  /// Reads and checks the file's header.
  Expected<void> check_container() {
    const std::span<const std::byte> magic = std::as_bytes(std::span(kFieldMagic));
    if (bytes_.size() < magic.size() ||
        !std::equal(magic.begin(), magic.end(), bytes_.begin(), bytes_.begin() + magic.size())) {
      return bad("", "is not a field file");
    }
    if (bytes_.size() < kHeaderBytes) return bad("", "is cut short: its header is not whole");
    in_ = ByteReader(bytes_.subspan(magic.size()));
    const std::uint32_t version = in_.u32();
    if (version != kFieldFileVersion) {
      return bad("", "is of version " + std::to_string(version) + "; version " +
                         std::to_string(kFieldFileVersion) + " can be read");
    }
    const std::uint32_t checksum = in_.u32();
    const std::uint64_t size = in_.u64();
    if (size > bytes_.size()) {
      return bad("", "is cut short: " + std::to_string(bytes_.size()) + " of " +
                         std::to_string(size) + " bytes are there");
    }
    if (size < bytes_.size()) {
      return bad("", "is longer than the " + std::to_string(size) + " bytes that it says");
    }
    if (checksum != crc32_of(bytes_.subspan(kSizeOffset))) {
      return bad("", "is broken: its checksum does not match what it holds");
    }
    return {};
  }

  Expected<VolumeHeader> read_volume_header() {
    if (in_.left() < kVolumeHeaderBytes) return bad(place_, "is cut short");
    VolumeHeader header;
    FieldVolume& volume = header.volume;
    header.bytes = in_.u64();
    const std::uint32_t irradiance_format = in_.u32(), distance_format = in_.u32();
    const std::uint32_t irradiance_texels = in_.u32(), distance_texels = in_.u32();
    if (irradiance_format >= kIrradianceFormatCount) {
      return bad(place_, "stores irradiance in an unknown format");
    }
    if (distance_format > static_cast<std::uint32_t>(DistanceFormat::rg32f)) {
      return bad(place_, "stores distances in an unknown format");
    }
    if (irradiance_texels < 2 || irradiance_texels > 16 || irradiance_texels % 2 != 0) {
      return bad(place_, "has irradiance tiles of a size that is not even or not 2 to 16");
    }
    if (distance_texels < 4 || distance_texels > 32) {
      return bad(place_, "has distance tiles of a size that is not 4 to 32");
    }
    volume.irradiance_texels = static_cast<int>(irradiance_texels);
    volume.distance_texels = static_cast<int>(distance_texels);
    volume.irradiance_format = static_cast<IrradianceFormat>(irradiance_format);
    volume.distance_format = static_cast<DistanceFormat>(distance_format);
    if (auto fine = read_grid(header); !fine) return tl::unexpected(fine.error());

    const std::uint32_t follows = in_.u32(), level = in_.u32();
    if (follows > 1 || level > kMaxCascades) return bad(place_, "has a role that no volume has");
    volume.role = {follows == 1, static_cast<int>(level)};
    if (follows == 1 && !can_scroll(volume.grid)) {
      return bad(place_, "cannot follow the viewer from where, or as, it stands");
    }
    header.irradiance_words = tile_words(header.probes, volume.irradiance_texels,
                                         words_per_texel(volume.irradiance_format));
    header.distance_words =
        tile_words(header.probes, volume.distance_texels, words_per_texel(volume.distance_format));
    return header;
  }

  Expected<void> read_grid(VolumeHeader& header) {
    ProbeGrid& grid = header.volume.grid;
    grid.origin_ws = read_vec3(in_);
    grid.spacing = read_vec3(in_);
    header.probes = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t along = in_.u32();
      // Check this before the product can overflow
      if (along < 2 || along > kMaxProbes) return bad(place_, "has a senseless number of probes");
      header.probes *= along;
      grid.count[axis] = static_cast<int>(along);
    }
    if (header.probes > kMaxProbes) return bad(place_, "has more probes than a field can");
    const float unit = in_.f32();
    for (int axis = 0; axis < 3; ++axis) grid.axes[axis] = read_vec3(in_);
    grid.fade_centre = read_vec3(in_);
    grid.fade_half = read_vec3(in_);
    grid.fade_cells = read_vec3(in_);

    for (int axis = 0; axis < 3; ++axis) {
      const float spacing = grid.spacing[axis];
      if (!(std::abs(grid.origin_ws[axis]) <= kMaxOrigin) || !(spacing >= kMinSpacing) ||
          !(spacing <= kMaxSpacing)) {
        return bad(place_, "stands at a place, or with a spacing, that makes no sense");
      }
      if (!std::isfinite(grid.fade_centre[axis]) || !std::isfinite(grid.fade_half[axis]) ||
          !(grid.fade_half[axis] > 0.0f) || !(grid.fade_cells[axis] > 0.0f)) {
        return bad(place_, "counts within a box that makes no sense");
      }
    }
    if (!is_rotation(grid.axes)) return bad(place_, "has axes that are no rotation");
    if (unit != distance_unit(grid)) {
      return bad(place_, "has distances in a unit that is not its grid's");
    }
    return {};
  }

  Expected<FieldVolume> read_volume(std::uint32_t updates) {
    Expected<VolumeHeader> header = read_volume_header();
    if (!header) return tl::unexpected(header.error());
    const std::uint64_t body = kRecordBytes * header->probes +
                               sizeof(uint) * (header->irradiance_words + header->distance_words);
    if (header->bytes != kVolumeHeaderBytes + body || body > in_.left()) {
      return bad(place_, "has a size that does not fit its probes");
    }
    FieldVolume volume = std::move(header->volume);
    volume.records.resize(header->probes);
    volume.offsets.resize(header->probes);
    for (std::size_t probe = 0; probe < volume.records.size(); ++probe) {
      if (!read_record(updates, volume.offsets[probe], volume.records[probe])) {
        return bad(place_, "holds a senseless record of probe " + std::to_string(probe));
      }
    }
    volume.irradiance.resize(header->irradiance_words);
    in_.u32s(volume.irradiance);
    volume.distance.resize(header->distance_words);
    in_.u32s(volume.distance);
    if ((volume.irradiance_format == IrradianceFormat::float32 &&
         !all_storable(volume.irradiance)) ||
        (volume.distance_format == DistanceFormat::rg32f && !all_storable(volume.distance))) {
      return bad(place_, "holds light or distances that are not within -1e18 to 1e18");
    }
    return volume;
  }

  /// Reads the blocks of corrections, which end the file.
  Expected<void> read_corrections(std::uint32_t volumes, std::vector<CorrectionBlock>& blocks) {
    if (in_.left() < sizeof(std::uint32_t)) return bad("corrections", "are cut short");
    const std::uint32_t count = in_.u32();
    if (in_.left() != kCorrectionBlockBytes * count) {
      return bad("corrections", "have a size that does not fit their number");
    }
    blocks.resize(count);
    for (CorrectionBlock& block : blocks) {
      block.key.xy = in_.u32();
      block.key.rest = in_.u32();
      if (!is_block_key(block.key, volumes)) return bad("corrections", "name a senseless block");
      for (LearnedCorrection& cell : block.cells) {
        cell = {in_.f32(), in_.f32(), in_.f32()};
        if (!is_sum(cell.gathered) || !is_sum(cell.looked_up) || !is_sum(cell.samples)) {
          return bad("corrections", "hold sums that are not within 0 to 1e18");
        }
      }
    }
    return {};
  }

  bool read_record(std::uint32_t updates, uint& offset, ProbeStatus& record) {
    offset = in_.u32();
    const std::uint32_t state = in_.u32();
    record.samples = in_.f32();
    record.variance = in_.f32();
    const std::uint32_t variance_samples = in_.u32();
    record.last_traced = in_.u32();
    if (state >= kStates || variance_samples > 0xFFFFu) return false;
    record.state = static_cast<ProbeState>(state);
    record.variance_samples = static_cast<std::uint16_t>(variance_samples);
    const bool on_grid = encode_probe_offset(decode_probe_offset(offset)) == offset;
    return on_grid && record.samples >= 0.0f && std::isfinite(record.samples) &&
           record.variance >= 0.0f && std::isfinite(record.variance) &&
           record.last_traced <= updates;
  }

  const std::string& name_;
  std::span<const std::byte> bytes_;
  ByteReader in_;
  std::string place_;
};

}  // namespace

FieldSettings FieldVolume::store_settings(FieldSettings others) const {
  others.irradiance_texels = irradiance_texels;
  others.distance_texels = distance_texels;
  others.irradiance_format = irradiance_format;
  others.distance_format = distance_format;
  others.probe_count = grid.count;
  others.probe_spacing = 0.0f;
  others.volume = {grid.origin_ws, grid.origin_ws + grid.spacing * vec3(grid.count - 1)};
  others.cascades = 0;
  others.volumes.clear();
  return others;
}

ProbeStore FieldVolume::store() const {
  ProbeStore store(grid, store_settings());
  store.restore(0, offsets, irradiance, distance);
  return store;
}

void restore_store(const FieldFile& file, ProbeStore& store) {
  for (int v = 0; v < store.volumes(); ++v) {
    const FieldVolume& volume = file.volumes[v];
    store.restore(store.grid(v).first, volume.offsets, volume.irradiance, volume.distance);
  }
}

void stored_light(const ProbeStore& store, int probe, std::span<vec4> tile) {
  const int n = store.irradiance_texels();
  for (int t = 0; t < n * n; ++t) {
    tile[t] = vec4(store.irradiance_texel(probe, ivec2(t % n, t / n) + 1), 0.0f);
  }
}

Expected<FieldFile> decode_field(const std::string& name, std::span<const std::byte> bytes) {
  return Reader(name, bytes).read();
}

Expected<FieldFile> read_field_file(const std::string& path) {
  const Expected<std::vector<std::byte>> bytes = read_file(path, kMaxFieldFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return decode_field(path, *bytes);
}

}  // namespace lambent
