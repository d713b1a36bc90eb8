// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>

#include "core/checksum.h"
#include "core/little_endian.h"
#include "field/file/field_file.h"
#include "field/file/field_stream.h"
#include "field/file/layout.h"

namespace lambent {
namespace {

std::uint64_t volume_bytes(const FieldVolume& volume) {
  return kVolumeHeaderBytes + kRecordBytes * volume.records.size() +
         sizeof(uint) * (volume.irradiance.size() + volume.distance.size());
}

// The size of the parts in which a stream writes [bytes].
constexpr std::size_t kStreamPart = std::size_t{1} << 20;

/// Writes numbers to a file, a part at a time, and computes their checksum.
class PartWriter {
 public:
  PartWriter(AtomicFile& file, std::uint32_t& checksum) : file_(file), checksum_(checksum) {}

  void u32(std::uint32_t value) { part_.u32(value), send_if_full(); }
  void u64(std::uint64_t value) { part_.u64(value), send_if_full(); }
  void f32(float value) { part_.f32(value), send_if_full(); }
  void u32s(std::span<const uint> values) {
    constexpr std::size_t kMost = kStreamPart / sizeof(uint);
    for (std::size_t first = 0; first < values.size(); first += kMost) {
      part_.u32s(values.subspan(first, std::min(kMost, values.size() - first)));
      send_if_full();
    }
  }
  /// Writes the last part. Fails if any part could not be written.
  Expected<void> finish() {
    send();
    return written_;
  }

 private:
  void send_if_full() {
    if (part_.size() >= kStreamPart) send();
  }
  void send() {
    checksum_ = crc32_of(part_.bytes(), checksum_);
    if (written_) written_ = file_.write(part_.bytes());
    part_.clear();
  }

  AtomicFile& file_;
  std::uint32_t& checksum_;
  ByteWriter part_;
  Expected<void> written_;
};

template <class Out>
void write_vec3(const glm::vec3& v, Out& out) {
  for (int axis = 0; axis < 3; ++axis) out.f32(v[axis]);
}

template <class Out>
void write_volume(const FieldVolume& volume, Out& out) {
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

/// Writes the part of the header before the size.
void write_start(ByteWriter& out) {
  out.raw(std::as_bytes(std::span(kFieldMagic)));
  out.u32(kFieldFileVersion);
  out.u32(0);  // replaced by the checksum at the end
  assert(out.size() == kSizeOffset);
}

/// Writes everything between the size and the blocks of corrections.
template <class Out>
void write_front(const FieldFile& field, std::uint32_t corrections, Out& out) {
  out.u32(static_cast<std::uint32_t>(field.volumes.size()));
  out.u32(field.updates);
  out.u64(field.scene.triangles);
  out.u64(field.scene.vertices);
  out.u32(field.scene.instances);
  out.u32(field.scene.geometry);
  out.u32(field.scene.light);
  out.u32(kHeaderBytes);
  for (const FieldVolume& volume : field.volumes) write_volume(volume, out);
  out.u32(corrections);
}

template <class Out>
void write_blocks(std::span<const CorrectionBlock> blocks, Out& out) {
  for (const CorrectionBlock& block : blocks) {
    out.u32(block.key.xy);
    out.u32(block.key.rest);
    for (const LearnedCorrection& cell : block.cells) {
      out.f32(cell.gathered);
      out.f32(cell.looked_up);
      out.f32(cell.samples);
    }
  }
}

}  // namespace

std::vector<std::byte> encode_field(const FieldFile& field) {
  ByteWriter out;
  write_start(out);
  out.u64(0);  // replaced below
  write_front(field, static_cast<std::uint32_t>(field.corrections.size()), out);
  write_blocks(field.corrections, out);
  std::vector<std::byte> bytes = out.take();
  seal_field(bytes);
  return bytes;
}

Expected<void> FieldStream::write_front(const FieldFile& field, std::uint32_t corrections) {
  std::uint64_t size = kHeaderBytes + sizeof(std::uint32_t) + kCorrectionBlockBytes * corrections;
  for (const FieldVolume& volume : field.volumes) size += volume_bytes(volume);
  ByteWriter start;
  write_start(start);
  if (const auto written = file_.write(start.bytes()); !written) return written;
  PartWriter out(file_, checksum_);
  out.u64(size);
  lambent::write_front(field, corrections, out);
  return out.finish();
}

Expected<void> FieldStream::write(std::span<const CorrectionBlock> blocks) {
  PartWriter out(file_, checksum_);
  write_blocks(blocks, out);
  return out.finish();
}

Expected<void> FieldStream::finish() {
  ByteWriter checksum;
  checksum.u32(checksum_);
  if (const auto found = file_.seek(begin_ + kChecksumOffset); !found) return found;
  return file_.write(checksum.bytes());
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
