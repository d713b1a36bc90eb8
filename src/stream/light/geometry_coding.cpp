// SPDX-License-Identifier: Apache-2.0
#include "stream/light/geometry_coding.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>

#include "core/little_endian.h"
#include "core/parallel.h"
#include "stream/light/message.h"
#include "stream/light/probe_coding.h"

namespace lambent::stream {
namespace {

// Sizes [bytes] of what stands before coded probes.
constexpr std::size_t kKindBytes = 16, kVolumeBytes = 124, kPlaceBytes = 60;

// Bytes of a client's state: coefficients and levels, and a decoded tile, of a texel; an encoded
// and two decoded moments of a texel; the rest of a probe.
constexpr std::uint64_t kTexelBytes = 40, kMomentsBytes = 12, kProbeBytes = 128;

// In place of the number of blocks: corrections are as they were.
constexpr std::uint32_t kSameCorrections = 0xFFFFFFFFu;

/// The blocks that a field of so many probes has room for.
std::uint64_t most_blocks(std::uint64_t probes) {
  return std::uint64_t{kCorrectionBucketsPerProbe} * kCorrectionBucket * probes;
}

void write_vec3(const vec3& v, ByteWriter& out) {
  for (int axis = 0; axis < 3; ++axis) out.f32(v[axis]);
}
vec3 read_vec3(ByteReader& in) {
  vec3 v;
  for (int axis = 0; axis < 3; ++axis) v[axis] = in.f32();
  return v;
}
void write_ivec3(const ivec3& v, ByteWriter& out) {
  for (int axis = 0; axis < 3; ++axis) out.u32(static_cast<std::uint32_t>(v[axis]));
}

/// Where a grid is: what scrolling changes.
void write_place(const ProbeGrid& grid, ByteWriter& out) {
  write_vec3(grid.origin_ws, out);
  write_ivec3(grid.scroll, out);
  write_vec3(grid.fade_centre, out);
  write_vec3(grid.fade_half, out);
  write_vec3(grid.fade_cells, out);
}

/// Returns whether what it reads makes sense.
bool read_place(ByteReader& in, ProbeGrid& grid) {
  grid.origin_ws = read_vec3(in);
  bool sound = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t scroll = in.u32();
    sound = sound && scroll < static_cast<std::uint32_t>(grid.count[axis]);
    grid.scroll[axis] = static_cast<int>(std::min<std::uint32_t>(scroll, kMaxProbes));
  }
  grid.fade_centre = read_vec3(in);
  grid.fade_half = read_vec3(in);
  grid.fade_cells = read_vec3(in);
  for (int axis = 0; axis < 3; ++axis) {
    sound = sound && std::abs(grid.origin_ws[axis]) <= kMaxOrigin &&
            std::isfinite(grid.fade_centre[axis]) && std::isfinite(grid.fade_half[axis]) &&
            grid.fade_half[axis] > 0.0f && grid.fade_cells[axis] > 0.0f;
  }
  return sound;
}

Expected<Volume> read_volume(ByteReader& in) {
  Volume volume{};
  ProbeGrid& grid = volume.grid;
  std::uint64_t probes = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t count = in.u32();
    if (count < 2 || count > kMaxProbes) return bad_stream("geometry", "has a senseless grid");
    probes *= count;
    if (probes > kMaxProbes) return bad_stream("geometry", "has more probes than a field can");
    grid.count[axis] = static_cast<int>(count);
  }
  grid.spacing = read_vec3(in);
  for (int axis = 0; axis < 3; ++axis) grid.axes[axis] = read_vec3(in);
  const std::uint32_t role = in.u32();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(grid.spacing[axis] >= kMinSpacing && grid.spacing[axis] <= kMaxSpacing)) {
      return bad_stream("geometry", "has a spacing that makes no sense");
    }
  }
  if (!is_rotation(grid.axes)) return bad_stream("geometry", "has axes that are no rotation");
  if (role >> 16u > 1 || (role & 0xFFFFu) > kMaxCascades) {
    return bad_stream("geometry", "has a role that no volume has");
  }
  volume.role = {role >> 16u == 1, static_cast<int>(role & 0xFFFFu)};
  if (!read_place(in, grid)) return bad_stream("geometry", "stands at a place that makes no sense");
  return volume;
}

void write_volume(const Volume& volume, ByteWriter& out) {
  write_ivec3(volume.grid.count, out);
  write_vec3(volume.grid.spacing, out);
  for (int axis = 0; axis < 3; ++axis) write_vec3(volume.grid.axes[axis], out);
  out.u32(static_cast<std::uint32_t>(volume.role.level) |
          (volume.role.follows_viewer ? 1u << 16u : 0u));
  write_place(volume.grid, out);
}

/// Probes' records are in sections, each with models of its own, so that all cores code them.
constexpr int kSectionProbes = 512;

std::size_t section_count(int probes) {
  return (static_cast<std::size_t>(probes) + kSectionProbes - 1) / kSectionProbes;
}

/// Calls body(section) for each; on all cores, where there are threads.
void for_each_section(std::size_t count, const std::function<void(std::size_t)>& body) {
#ifdef __EMSCRIPTEN__
  for (std::size_t section = 0; section < count; ++section) body(section);
#else
  parallel_chunks(count, 1, [&](std::size_t begin, std::size_t) { body(begin); });
#endif
}

/// Codes the records of a section. Returns false on what no encoder wrote.
template <class Coder>
bool code_section(Coder& coder, std::size_t section, FieldGeometry& geometry) {
  ProbeModels models;
  const std::vector<CodedMoments> blank(geometry.tile());
  const int first = static_cast<int>(section) * kSectionProbes;
  const int end = std::min(first + kSectionProbes, geometry.probes());
  for (int probe = first; probe < end; ++probe) {
    if (!code_probe(coder, models, probe, blank, geometry)) return false;
  }
  return true;
}

/// The bytes of corrections, and of each section.
Expected<std::vector<std::span<const std::byte>>> read_sections(std::span<const std::byte> bytes,
                                                                int probes) {
  std::vector<std::span<const std::byte>> sections(section_count(probes) + 1);
  ByteReader sizes(bytes);
  if (sizes.left() < sizeof(std::uint32_t) * sections.size()) {
    return bad_stream("geometry", "is cut short");
  }
  std::span<const std::byte> rest = bytes.subspan(sizeof(std::uint32_t) * sections.size());
  for (std::span<const std::byte>& section : sections) {
    const std::uint32_t size = sizes.u32();
    if (size > rest.size()) return bad_stream("geometry", "is cut short");
    section = rest.first(size);
    rest = rest.subspan(size);
  }
  if (!rest.empty()) return bad_stream("geometry", "goes on after its end");
  return sections;
}

/// How many volumes and blocks of corrections there are.
struct Counts {
  std::uint32_t volumes = 0, blocks = 0;
};

/// Reads what the tiles are like and how much there is.
Expected<Counts> read_kind(ByteReader& in, FieldGeometry& geometry) {
  const std::uint32_t irradiance_texels = in.u32(), distance_texels = in.u32();
  const Counts counts = {in.u32(), in.u32()};
  if (irradiance_texels < 2 || irradiance_texels > 16 || irradiance_texels % 2 != 0 ||
      distance_texels < 4 || distance_texels > 32) {
    return bad_stream("geometry", "has tiles of a size that no field has");
  }
  if (counts.volumes < 1 || counts.volumes > kMaxVolumes) {
    return bad_stream("geometry", "has " + std::to_string(counts.volumes) + " volumes");
  }
  geometry.irradiance_texels = static_cast<int>(irradiance_texels);
  geometry.distance_texels = static_cast<int>(distance_texels);
  return counts;
}

}  // namespace

std::vector<std::byte> write_geometry(const FieldGeometry& geometry) {
  ByteWriter out;
  out.u32(static_cast<std::uint32_t>(geometry.irradiance_texels));
  out.u32(static_cast<std::uint32_t>(geometry.distance_texels));
  out.u32(static_cast<std::uint32_t>(geometry.volumes.size()));
  out.u32(static_cast<std::uint32_t>(geometry.corrections.size()));
  for (const Volume& volume : geometry.volumes) write_volume(volume, out);
  FieldGeometry copy = geometry;
  std::vector<std::vector<std::byte>> sections(section_count(geometry.probes()) + 1);
  for_each_section(sections.size(), [&](std::size_t section) {
    RangeEncoder coder;
    if (section == 0) {
      write_corrections(coder, geometry.corrections);
    } else {
      code_section(coder, section - 1, copy);
    }
    sections[section] = coder.finish();
  });
  for (const auto& section : sections) out.u32(static_cast<std::uint32_t>(section.size()));
  for (const auto& section : sections) out.raw(section);
  return out.take();
}

Expected<FieldGeometry> read_geometry(std::span<const std::byte> body, std::size_t most_bytes) {
  const auto cut_short = [] { return bad_stream("geometry", "is cut short"); };
  if (body.size() < kKindBytes) return cut_short();
  FieldGeometry geometry;
  ByteReader in(body);
  const Expected<Counts> counts = read_kind(in, geometry);
  if (!counts) return tl::unexpected(counts.error());
  if (in.left() < kVolumeBytes * counts->volumes) return cut_short();
  std::uint64_t probes = 0;
  for (std::uint32_t i = 0; i < counts->volumes; ++i) {
    Expected<Volume> volume = read_volume(in);
    if (!volume) return tl::unexpected(volume.error());
    volume->grid.first = static_cast<int>(probes);
    probes += static_cast<std::uint64_t>(probe_count(volume->grid));
    if (probes > kMaxProbes) return bad_stream("geometry", "has more probes than a field can");
    geometry.volumes.push_back(*volume);
  }
  const std::uint64_t texels =
      std::uint64_t(geometry.irradiance_texels) * geometry.irradiance_texels;
  if (probes * (kTexelBytes * texels + kMomentsBytes * geometry.tile() + kProbeBytes) >
      most_bytes) {
    return bad_stream("geometry", "would take more memory than is allowed");
  }
  if (counts->blocks > most_blocks(probes)) {
    return bad_stream("geometry", "has more corrections than a field can");
  }
  geometry.offsets.resize(probes);
  geometry.states.resize(probes);
  geometry.moments.resize(probes * geometry.tile());
  geometry.corrections.resize(counts->blocks);
  const auto sections = read_sections(body.subspan(body.size() - in.left()), geometry.probes());
  if (!sections) return tl::unexpected(sections.error());
  std::vector<std::uint8_t> sound(sections->size());
  for_each_section(sections->size(), [&](std::size_t section) {
    RangeDecoder coder((*sections)[section]);
    const bool read = section == 0 ? read_corrections(coder, counts->volumes, geometry.corrections)
                                   : code_section(coder, section - 1, geometry) && !coder.overrun();
    sound[section] = read && coder.left() == 0 ? 1 : 0;
  });
  if (sound[0] == 0) return bad_stream("geometry", "holds senseless corrections");
  const auto bad = std::find(sound.begin(), sound.end(), std::uint8_t{0});
  if (bad != sound.end()) {
    return bad_stream("geometry", "holds senseless records in section " +
                                      std::to_string(std::distance(sound.begin(), bad)));
  }
  return geometry;
}

std::vector<std::byte> write_changes(const FieldGeometry& before, const FieldGeometry& now,
                                     std::span<const int> probes, bool with_corrections) {
  ByteWriter out;
  out.u32(with_corrections ? static_cast<std::uint32_t>(now.corrections.size()) : kSameCorrections);
  for (const Volume& volume : now.volumes) write_place(volume.grid, out);
  RangeEncoder coder;
  ProbeModels models;
  FieldGeometry copy = now;
  std::size_t next = 0;
  bool last = false;
  for (int probe = 0; probe < now.probes(); ++probe) {
    const bool changed = next < probes.size() && probes[next] == probe;
    code_bit(coder, models.changed[last ? 1 : 0], changed);
    last = changed;
    if (!changed) continue;
    ++next;
    code_probe(coder, models, probe,
               std::span(before.moments).subspan(probe * before.tile(), before.tile()), copy);
  }
  if (with_corrections) write_corrections(coder, now.corrections);
  out.raw(coder.finish());
  return out.take();
}

Expected<GeometryChanges> read_changes(std::span<const std::byte> body, FieldGeometry& geometry) {
  if (body.size() < sizeof(std::uint32_t) + kPlaceBytes * geometry.volumes.size()) {
    return bad_stream("geometry", "is cut short");
  }
  FieldGeometry now = geometry;
  ByteReader in(body);
  const std::uint32_t blocks = in.u32();
  if (blocks != kSameCorrections && blocks > most_blocks(now.offsets.size())) {
    return bad_stream("geometry", "has more corrections than a field can");
  }
  for (Volume& volume : now.volumes) {
    if (!read_place(in, volume.grid)) {
      return bad_stream("geometry", "moves to a place that makes no sense");
    }
  }
  GeometryChanges changes;
  changes.corrections = blocks != kSameCorrections;
  RangeDecoder coder(body.subspan(body.size() - in.left()));
  ProbeModels models;
  bool last = false;
  for (int probe = 0; probe < now.probes(); ++probe) {
    last = code_bit(coder, models.changed[last ? 1 : 0], false);
    if (coder.overrun()) return bad_stream("geometry", "ends before its last probe");
    if (!last) continue;
    changes.probes.push_back(probe);
    if (!code_probe(coder, models, probe,
                    std::span(geometry.moments).subspan(probe * now.tile(), now.tile()), now)) {
      return bad_stream("geometry", "holds a senseless record of probe " + std::to_string(probe));
    }
  }
  if (changes.corrections) {
    now.corrections.assign(blocks, {});
    if (!read_corrections(coder, static_cast<std::uint32_t>(now.volumes.size()), now.corrections)) {
      return bad_stream("geometry", "holds senseless corrections");
    }
  }
  if (coder.left() > 0) return bad_stream("geometry", "goes on after its end");
  geometry = std::move(now);
  return changes;
}

}  // namespace lambent::stream
