// SPDX-License-Identifier: Apache-2.0
#include <cassert>

#include "core/checksum.h"
#include "core/little_endian.h"
#include "field/file/field_file.h"
#include "field/file/layout.h"

namespace lambent {
namespace {

std::uint64_t volume_bytes(const FieldVolume& volume) {
  return kVolumeHeaderBytes + kRecordBytes * volume.records.size() +
         sizeof(uint) * (volume.irradiance.size() + volume.distance.size());
}

void write_vec3(const glm::vec3& v, ByteWriter& out) {
  for (int axis = 0; axis < 3; ++axis) out.f32(v[axis]);
}

void write_volume(const FieldVolume& volume, ByteWriter& out) {
  const ProbeGrid& grid = volume.grid;
  assert(volume.records.size() == static_cast<std::size_t>(probe_count(grid)));
  assert(grid.scroll == ivec3(0));
  assert(volume.offsets.size() == volume.records.size());
  out.u64(volume_bytes(volume));
  out.u32(static_cast<std::uint32_t>(volume.irradiance_format));
  out.u32(static_cast<std::uint32_t>(volume.distance_format));
  out.u32(static_cast<std::uint32_t>(volume.irradiance_texels));
  out.u32(static_cast<std::uint32_t>(volume.distance_texels));
  write_vec3(grid.origin_ws, out);
  write_vec3(grid.spacing, out);
  for (int axis = 0; axis < 3; ++axis) out.u32(static_cast<std::uint32_t>(grid.count[axis]));
  out.f32(distance_unit(grid));
  for (int axis = 0; axis < 3; ++axis) write_vec3(grid.axes[axis], out);
  write_vec3(grid.fade_centre, out);
  write_vec3(grid.fade_half, out);
  write_vec3(grid.fade_cells, out);
  out.u32(volume.role.follows_viewer ? 1 : 0);
  out.u32(static_cast<std::uint32_t>(volume.role.level));

  for (std::size_t probe = 0; probe < volume.records.size(); ++probe) {
    const ProbeStatus& record = volume.records[probe];
    out.u32(volume.offsets[probe]);
    out.u32(static_cast<std::uint32_t>(record.state));
    out.f32(record.samples);
    out.f32(record.variance);
    out.u32(record.variance_samples);
    out.u32(record.last_traced);
  }
  out.u32s(volume.irradiance);
  out.u32s(volume.distance);
}

}  // namespace

std::vector<std::byte> encode_field(const FieldFile& field) {
  ByteWriter out;
  out.raw(std::as_bytes(std::span(kFieldMagic)));
  out.u32(kFieldFileVersion);
  out.u32(0);  // replaced by the checksum and the size below
  out.u64(0);
  out.u32(static_cast<std::uint32_t>(field.volumes.size()));
  out.u32(field.updates);
  out.u64(field.scene.triangles);
  out.u64(field.scene.vertices);
  out.u32(field.scene.instances);
  out.u32(field.scene.geometry);
  out.u32(field.scene.light);
  out.u32(kHeaderBytes);
  assert(out.size() == kHeaderBytes);
  for (const FieldVolume& volume : field.volumes) write_volume(volume, out);
  out.u32(static_cast<std::uint32_t>(field.corrections.size()));
  for (const CorrectionBlock& block : field.corrections) {
    out.u32(block.key.xy);
    out.u32(block.key.rest);
    for (const LearnedCorrection& cell : block.cells) {
      out.f32(cell.gathered);
      out.f32(cell.looked_up);
      out.f32(cell.samples);
    }
  }
  std::vector<std::byte> bytes = out.take();
  seal_field(bytes);
  return bytes;
}

void seal_field(std::span<std::byte> bytes) {
  if (bytes.size() < kHeaderBytes) return;
  ByteWriter numbers;
  numbers.u64(bytes.size());
  std::copy(numbers.bytes().begin(), numbers.bytes().end(), bytes.begin() + kSizeOffset);
  numbers.clear();
  numbers.u32(crc32_of(bytes.subspan(kSizeOffset)));
  std::copy(numbers.bytes().begin(), numbers.bytes().end(), bytes.begin() + kChecksumOffset);
}

}  // namespace lambent
