// SPDX-License-Identifier: Apache-2.0
#include "stream/light/geometry_coding.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "core/little_endian.h"
#include "stream/light/message.h"
#include "stream/light/on_all_cores.h"
#include "stream/light/probe_coding.h"

namespace lambent::stream {
namespace {

// Sizes of headers before coded probes [bytes].
constexpr std::size_t kKindBytes = 24, kVolumeBytes = 124, kPlaceBytes = 60;

// Bytes of a client's state per texel of irradiance (coefficients, levels, and a decoded tile), per
// texel of distance (encoded moments and two decoded ones), per probe (the rest), and per block of
// corrections (encoded, as received, and decoded).
constexpr std::uint64_t kTexelBytes = 40, kMomentsBytes = 12, kProbeBytes = 128,
                        kBlockBytes = 2 * sizeof(CodedCorrectionBlock) + kMostBlockBytes;

// Value of the number of blocks if corrections have not changed.
constexpr std::uint32_t kSameCorrections = 0xFFFFFFFFu;

/// The largest number of blocks in a field of `probes` probes.
std::uint64_t most_blocks(std::uint64_t probes) {
  return std::uint64_t{kCorrectionBucketsPerProbe} * kCorrectionBucket * probes;
}

/// Size of a client's state [bytes].
std::uint64_t state_bytes(const FieldGeometry& kind, std::uint64_t probes, std::uint64_t blocks) {
  const auto texels = static_cast<std::uint64_t>(kind.irradiance_texels) * kind.irradiance_texels;
  return probes * (kTexelBytes * texels + kMomentsBytes * kind.tile() + kProbeBytes) +
         blocks * kBlockBytes;
}

tl::unexpected<Error> too_large() {
  return bad_stream("geometry", "would take more memory than is allowed");
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

/// Writes the place of a grid, which scrolling changes.
void write_place(const ProbeGrid& grid, ByteWriter& out) {
  write_vec3(grid.origin_ws, out);
  write_ivec3(grid.scroll, out);
  write_vec3(grid.fade_centre, out);
  write_vec3(grid.fade_half, out);
  write_vec3(grid.fade_cells, out);
}

/// Reads the place of a grid; returns whether it is valid.
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

std::size_t section_count(int probes) {
  return (static_cast<std::size_t>(probes) + kSectionProbes - 1) / kSectionProbes;
}

/// Codes the records of a section. Returns false on data that no encoder wrote.
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

/// The sections in one part.
struct CodedSections {
  std::size_t first = 0;
  std::vector<std::span<const std::byte>> bytes;
};

Expected<CodedSections> read_sections(std::span<const std::byte> bytes, std::size_t all) {
  constexpr std::size_t kHeadBytes = 2 * sizeof(std::uint32_t);
  if (bytes.size() < kHeadBytes) return bad_stream("geometry", "is cut short");
  ByteReader in(bytes);
  CodedSections sections;
  sections.first = in.u32();
  const std::size_t count = in.u32();
  if (sections.first > all || count > all - sections.first) {
    return bad_stream("geometry", "has records of more probes than there are");
  }
  if (in.left() < sizeof(std::uint32_t) * count) return bad_stream("geometry", "is cut short");
  std::span<const std::byte> rest = bytes.subspan(kHeadBytes + sizeof(std::uint32_t) * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t size = in.u32();
    if (size > rest.size()) return bad_stream("geometry", "is cut short");
    sections.bytes.push_back(rest.first(size));
    rest = rest.subspan(size);
  }
  if (!rest.empty()) return bad_stream("geometry", "goes on after its end");
  return sections;
}

/// Numbers of volumes and of blocks of corrections.
struct Counts {
  std::uint32_t volumes = 0, blocks = 0;
};

/// Reads the sizes of tiles, and the numbers of volumes and blocks.
Expected<Counts> read_kind(ByteReader& in, FieldGeometry& geometry) {
  const std::uint32_t irradiance_texels = in.u32(), distance_texels = in.u32();
  const Counts counts = {in.u32(), in.u32()};
  geometry.corrections_number = in.u64();
  if (irradiance_texels < 2 || irradiance_texels > 16 || irradiance_texels % 2 != 0 ||
      distance_texels < 4 || distance_texels > FieldGeometry::kMaxDistanceTexels) {
    return bad_stream("geometry", "has tiles of a size that no field has");
  }
  if (counts.volumes < 1 || counts.volumes > kMaxVolumes) {
    return bad_stream("geometry", "has " + std::to_string(counts.volumes) + " volumes");
  }
  geometry.irradiance_texels = static_cast<int>(irradiance_texels);
  geometry.distance_texels = static_cast<int>(distance_texels);
  return counts;
}

/// The header of a part: a geometry whose probes and corrections are not allocated yet.
struct Head {
  FieldGeometry geometry;
  std::uint64_t probes = 0;
  std::uint32_t blocks = 0;
};

Expected<Head> read_head(ByteReader& in, std::size_t most_bytes) {
  const auto cut_short = [] { return bad_stream("geometry", "is cut short"); };
  if (in.left() < kKindBytes) return cut_short();
  FieldGeometry geometry;
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
  if (counts->blocks > most_blocks(probes)) {
    return bad_stream("geometry", "has more corrections than a field can");
  }
  if (state_bytes(geometry, probes, counts->blocks) > most_bytes) return too_large();
  return Head{std::move(geometry), probes, counts->blocks};
}

/// A geometry of which nothing was received yet.
PartialGeometry begin(Head&& head) {
  PartialGeometry begun{std::move(head.geometry), {}};
  begun.geometry.corrections.resize(head.blocks);
  begun.geometry.offsets.resize(head.probes);
  begun.geometry.states.resize(head.probes);
  begun.geometry.moments.resize(head.probes * begun.geometry.tile());
  begun.here.resize(section_count(begun.geometry.probes()));
  return begun;
}

bool is_of(const Head& head, const FieldGeometry& geometry) {
  return geometry.same_kind(head.geometry) && geometry.corrections.size() == head.blocks &&
         geometry.corrections_number == head.geometry.corrections_number &&
         std::equal(geometry.volumes.begin(), geometry.volumes.end(), head.geometry.volumes.begin(),
                    [](const Volume& x, const Volume& y) { return same_place(x.grid, y.grid); });
}

/// A geometry that has these probes alone, and neither volumes nor corrections.
FieldGeometry records_of(std::span<const int> probes, const FieldGeometry& geometry) {
  FieldGeometry records;
  records.distance_texels = geometry.distance_texels;
  for (const int probe : probes) {
    records.offsets.push_back(geometry.offsets[probe]);
    records.states.push_back(geometry.states[probe]);
    const std::span<const CodedMoments> tile = geometry.tile_of(probe);
    records.moments.insert(records.moments.end(), tile.begin(), tile.end());
  }
  return records;
}

}  // namespace

void forget_sections(std::span<const int> probes, GeometrySections& sections) {
  for (const int probe : probes) {
    const auto section = static_cast<std::size_t>(probe / kSectionProbes);
    if (section < sections.size()) sections[section].clear();
  }
}

std::vector<std::vector<std::byte>> write_geometry(const FieldGeometry& geometry,
                                                   GeometrySections& sections) {
  FieldGeometry copy = geometry;
  sections.resize(section_count(geometry.probes()));
  on_all_cores(sections.size(), [&](std::size_t section) {
    if (!sections[section].empty()) return;
    RangeEncoder coder;
    code_section(coder, section, copy);
    sections[section] = coder.finish();
  });
  std::vector<std::vector<std::byte>> parts;
  for (std::size_t first = 0; first < sections.size(); first += kPartSections) {
    const auto part =
        std::span(sections).subspan(first, std::min(kPartSections, sections.size() - first));
    ByteWriter out;
    out.u32(static_cast<std::uint32_t>(geometry.irradiance_texels));
    out.u32(static_cast<std::uint32_t>(geometry.distance_texels));
    out.u32(static_cast<std::uint32_t>(geometry.volumes.size()));
    out.u32(static_cast<std::uint32_t>(geometry.corrections.size()));
    out.u64(geometry.corrections_number);
    for (const Volume& volume : geometry.volumes) write_volume(volume, out);
    out.u32(static_cast<std::uint32_t>(first));
    out.u32(static_cast<std::uint32_t>(part.size()));
    for (const auto& section : part) out.u32(static_cast<std::uint32_t>(section.size()));
    for (const auto& section : part) out.raw(section);
    parts.push_back(out.take());
  }
  return parts;
}

std::vector<LightMessage> geometry_messages(const MessageHeader& header,
                                            const FieldGeometry& geometry,
                                            GeometrySections& sections) {
  std::vector<LightMessage> messages;
  for (const std::vector<std::byte>& part : write_geometry(geometry, sections)) {
    messages.push_back(make_message(header, geometry_body(0, part)));
  }
  return messages;
}

Expected<void> read_geometry(std::span<const std::byte> body, std::size_t most_bytes,
                             PartialGeometry& geometry) {
  ByteReader in(body);
  Expected<Head> head = read_head(in, most_bytes);
  if (!head) return tl::unexpected(head.error());
  const std::size_t all = section_count(static_cast<int>(head->probes));
  const auto sections = read_sections(body.subspan(body.size() - in.left()), all);
  if (!sections) return tl::unexpected(sections.error());
  const bool begins = geometry.here.empty();
  if (!begins && !is_of(*head, geometry.geometry)) {
    return bad_stream("geometry", "goes on as another one than it began");
  }
  PartialGeometry begun;
  if (begins) begun = begin(std::move(*head));
  PartialGeometry& into = begins ? begun : geometry;
  std::vector<std::uint8_t> sound(sections->bytes.size());
  on_all_cores(sound.size(), [&](std::size_t i) {
    const std::size_t section = sections->first + i;
    RangeDecoder coder(sections->bytes[i]);
    const bool read = into.here[section] != 0 || (code_section(coder, section, into.geometry) &&
                                                  !coder.overrun() && coder.left() == 0);
    sound[i] = read ? 1 : 0;
  });
  const auto bad = std::find(sound.begin(), sound.end(), std::uint8_t{0});
  if (bad != sound.end()) {
    return bad_stream("geometry",
                      "holds senseless records in section " +
                          std::to_string(sections->first + std::distance(sound.begin(), bad)));
  }
  std::fill_n(into.here.begin() + static_cast<std::ptrdiff_t>(sections->first), sound.size(),
              std::uint8_t{1});
  if (begins) geometry = std::move(begun);
  return {};
}

std::vector<std::byte> write_changes(const UpdatedProbes& updated, const FieldGeometry& now,
                                     bool other_corrections) {
  ByteWriter out;
  out.u32(other_corrections ? static_cast<std::uint32_t>(now.corrections.size())
                            : kSameCorrections);
  for (const Volume& volume : now.volumes) write_place(volume.grid, out);
  RangeEncoder coder;
  ProbeModels models;
  FieldGeometry records = records_of(updated.probes, now);
  const std::span tiles_before(updated.tiles_before);
  int next = 0;
  bool last = false;
  for (int probe = 0; probe < now.probes(); ++probe) {
    const bool changed = next < records.probes() && updated.probes[next] == probe;
    code_bit(coder, models.changed[last ? 1 : 0], changed);
    last = changed;
    if (!changed) continue;
    code_probe(coder, models, next, tiles_before.subspan(next * now.tile(), now.tile()), records);
    ++next;
  }
  out.raw(coder.finish());
  return out.take();
}

Expected<GeometryChanges> read_changes(std::span<const std::byte> body, std::size_t most_bytes,
                                       FieldGeometry& geometry) {
  if (body.size() < sizeof(std::uint32_t) + kPlaceBytes * geometry.volumes.size()) {
    return bad_stream("geometry", "is cut short");
  }
  FieldGeometry now = geometry;
  ByteReader in(body);
  const std::uint32_t blocks = in.u32();
  if (blocks != kSameCorrections) {
    if (blocks > most_blocks(now.offsets.size())) {
      return bad_stream("geometry", "has more corrections than a field can");
    }
    if (state_bytes(now, now.offsets.size(), blocks) > most_bytes) return too_large();
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
    if (!code_probe(coder, models, probe, geometry.tile_of(probe), now)) {
      return bad_stream("geometry", "holds a senseless record of probe " + std::to_string(probe));
    }
  }
  if (changes.corrections) now.corrections.assign(blocks, {});
  if (coder.left() > 0) return bad_stream("geometry", "goes on after its end");
  geometry = std::move(now);
  return changes;
}

}  // namespace lambent::stream
