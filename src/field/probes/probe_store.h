// SPDX-License-Identifier: Apache-2.0
// The store of a field: the encoded octahedral tiles of its probes, with gutters.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/large_pages.h"
#include "field/lookup/lookup_records.h"
#include "field/probes/irradiance_encoding.h"
#include "field/probes/probe_grid.h"
#include "field/probes/tile.h"
#include "lambent/field.h"

namespace lambent {

/// Seed of the dither with which an update stores its results.
uint store_dither_seed(uint update, uint seed);

/// The tiles and offsets of the probes of all volumes, probe after probe. A tile has (texels + 2)^2
/// texels, row after row, gutter included.
class ProbeStore {
 public:
  /// Makes an empty store for volumes in the order in which lookups use them; the last one takes
  /// the remaining weight. Sets ProbeGrid::first of each.
  ProbeStore(std::span<const ProbeGrid> grids, const FieldSettings& settings);
  ProbeStore(const ProbeGrid& grid, const FieldSettings& settings)
      : ProbeStore(std::span(&grid, 1), settings) {}

  int volumes() const { return static_cast<int>(grids_.size()); }
  const ProbeGrid& grid(int volume) const { return grids_[volume]; }
  std::span<const ProbeGrid> grids() const { return grids_; }
  /// The volume that a probe belongs to.
  int volume_of(int probe) const;
  const ProbeGrid& grid_of(int probe) const { return grids_[volume_of(probe)]; }
  /// Replaces the grid of a volume by one of the same count and spacing. ProbeGrid::first stays.
  void move_volume(int volume, const ProbeGrid& grid);

  /// The relative indices of cells' corners. Entry kCellWraps v + w is for the cells of volume v
  /// that wrap around the end of memory in the directions w (cell_wrap).
  std::span<const CornerOffsets> corner_table() const { return corner_table_; }

  int probes() const { return probes_; }
  int irradiance_texels() const { return irradiance_texels_; }
  int distance_texels() const { return distance_texels_; }
  IrradianceFormat irradiance_format() const { return irradiance_format_; }
  DistanceFormat distance_format() const { return distance_format_; }
  /// Bytes of the tiles. Offsets take four more per probe.
  std::size_t bytes() const { return 4 * (irradiance_.size() + distance_.size()); }

  /// The position of a probe, with its offset.
  vec3 probe_position_ws(int probe) const {
    const ProbeGrid& grid = grid_of(probe);
    return placed_position(grid, probe_coords(grid, probe), probe_offset(probe));
  }
  /// The place of a probe on the grid, without its offset.
  vec3 probe_grid_position_ws(int probe) const {
    const ProbeGrid& grid = grid_of(probe);
    return probe_position(grid, probe_coords(grid, probe));
  }
  /// Offset of a probe from its place on the grid [cells], at most kMaxProbeOffset along each axis.
  vec3 probe_offset(int probe) const { return decode_probe_offset(offsets_[probe]); }
  void set_probe_offset(int probe, const vec3& cells) {
    offsets_[probe] = encode_probe_offset(cells);
  }
  std::span<const uint> offset_words() const { return offsets_; }
  std::span<uint> offset_words() { return offsets_; }

  /// Irradiance [W/m^2] of a texel, coordinates with gutter (0 to texels + 1).
  vec3 irradiance_texel(int probe, ivec2 with_gutter) const;
  /// Mean distance [m] and mean squared distance [m^2] of a texel, coordinates with gutter.
  vec2 moments_texel(int probe, ivec2 with_gutter) const;

  /// Bilinear fetches along a unit direction.
  vec3 irradiance(int probe, const vec3& direction) const;
  vec2 moments(int probe, const vec3& direction) const;

  /// Encodes a probe's interior texels, row after row, and fills the gutter. Calls with different
  /// dither seeds dither independently.
  void store_irradiance(int probe, std::span<const vec3> interior, uint dither_seed);
  /// Blends a probe's moments with new ones, whose weight is `blend_weight`, 0 to 1, and fills the
  /// gutter.
  void blend_moments(int probe, std::span<const vec2> interior, float blend_weight,
                     uint dither_seed);

  /// The encoded words, for kernels: words_per_irradiance_texel() or words_per_distance_texel()
  /// words per texel. Distances are in units of distance_unit() of the volume.
  std::span<const uint> irradiance_words() const { return irradiance_; }
  std::span<const uint> distance_words() const { return distance_; }
  std::span<uint> irradiance_words() { return irradiance_; }
  std::span<uint> distance_words() { return distance_; }
  int words_per_irradiance_texel() const { return words_of_irradiance(irradiance_code()); }
  int words_per_distance_texel() const { return distance_format_ == DistanceFormat::rg32f ? 2 : 1; }

  /// Replaces the words of the probes from `first` on by those that offset_words, irradiance_words
  /// and distance_words of a store with the same tiles returned.
  void restore(int first, std::span<const uint> offsets, std::span<const uint> irradiance,
               std::span<const uint> distance);

  /// Clears everything: no light, distances of 0, and no offsets.
  void clear();

 private:
  /// The format's number, as irradiance_encoding.h takes it.
  uint irradiance_code() const { return static_cast<uint>(irradiance_format_); }

  std::vector<ProbeGrid> grids_;
  std::vector<CornerOffsets> corner_table_;
  int probes_ = 0;
  int irradiance_texels_;
  int distance_texels_;
  IrradianceFormat irradiance_format_;
  DistanceFormat distance_format_;
  // Aligned so that a row of a default distance tile fills one cache line
  std::vector<uint, LargePages<uint>> irradiance_;
  std::vector<uint, LargePages<uint>> distance_;
  std::vector<uint> offsets_;
};

}  // namespace lambent
