// SPDX-License-Identifier: Apache-2.0
// What probes hold between updates: encoded octahedral tiles with gutters.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/large_pages.h"
#include "field/lookup/lookup_records.h"
#include "field/probes/probe_grid.h"
#include "field/probes/tile.h"
#include "lambent/field.h"

namespace lambent {

/// Of the dither of an update's stores.
uint store_dither_seed(uint update, uint seed);

/// Tiles of the probes of all volumes, probe after probe; a tile is (texels + 2)^2 texels, row
/// after row, gutter included.
class ProbeStore {
 public:
  /// Volumes in the order in which points ask them; the last one answers for what is left. Sets
  /// where each begins.
  ProbeStore(std::span<const ProbeGrid> grids, const FieldSettings& settings);
  ProbeStore(const ProbeGrid& grid, const FieldSettings& settings)
      : ProbeStore(std::span(&grid, 1), settings) {}

  int volumes() const { return static_cast<int>(grids_.size()); }
  const ProbeGrid& grid(int volume) const { return grids_[volume]; }
  std::span<const ProbeGrid> grids() const { return grids_; }
  /// Of a probe.
  int volume_of(int probe) const;
  const ProbeGrid& grid_of(int probe) const { return grids_[volume_of(probe)]; }
  /// Moves a volume: everything but its shape and its place in memory may differ.
  void move_volume(int volume, const ProbeGrid& grid);

  /// Where the corners of cells lie: entry kCellWraps v + w is of those cells of volume v that run
  /// over the end of memory in the directions w (cell_wrap).
  std::span<const CornerOffsets> corner_table() const { return corner_table_; }

  int probes() const { return probes_; }
  int irradiance_texels() const { return irradiance_texels_; }
  int distance_texels() const { return distance_texels_; }
  IrradianceFormat irradiance_format() const { return irradiance_format_; }
  DistanceFormat distance_format() const { return distance_format_; }
  /// Of the tiles; offsets take four more a probe.
  std::size_t bytes() const { return 4 * (irradiance_.size() + distance_.size()); }

  /// Where a probe stands: on the grid, or a little off it.
  vec3 probe_position_ws(int probe) const {
    const ProbeGrid& grid = grid_of(probe);
    return placed_position(grid, probe_coords(grid, probe), probe_offset(probe));
  }
  /// Where it belongs.
  vec3 probe_home_ws(int probe) const {
    const ProbeGrid& grid = grid_of(probe);
    return probe_position(grid, probe_coords(grid, probe));
  }
  /// Offset from the grid, in shares of a cell along each axis, at most kMaxProbeOffset.
  vec3 probe_offset(int probe) const { return decode_probe_offset(offsets_[probe]); }
  void set_probe_offset(int probe, const vec3& cells) {
    offsets_[probe] = encode_probe_offset(cells);
  }
  std::span<const uint> offset_words() const { return offsets_; }

  /// Irradiance [W/m^2] of a texel, coordinates with gutter (0 to texels + 1).
  vec3 irradiance_texel(int probe, ivec2 with_gutter) const;
  /// Mean distance [m] and mean squared distance [m^2] of a texel, coordinates with gutter.
  vec2 moments_texel(int probe, ivec2 with_gutter) const;

  /// Bilinear fetches along a unit direction.
  vec3 irradiance(int probe, const vec3& direction) const;
  vec2 moments(int probe, const vec3& direction) const;

  /// Encodes a probe's interior texels, row after row, and fills the gutter. `salt` (say, a hash of
  /// update and seed) makes the dither of this call its own.
  void store_irradiance(int probe, std::span<const vec3> interior, uint dither_seed);
  /// Moves a probe's moments a share of the way to new ones, 0 to 1, likewise.
  void blend_moments(int probe, std::span<const vec2> interior, float blend_weight,
                     uint dither_seed);

  /// The encoded words, for kernels; `words_per_*_texel` of them a texel. Distances are in units of
  /// distance_unit of the volume.
  std::span<const uint> irradiance_words() const { return irradiance_; }
  std::span<const uint> distance_words() const { return distance_; }
  int words_per_irradiance_texel() const {
    return irradiance_format_ == IrradianceFormat::float32 ? 3 : 1;
  }
  int words_per_distance_texel() const { return distance_format_ == DistanceFormat::rg32f ? 2 : 1; }

  /// Puts back what offset_words, irradiance_words and distance_words told of probes from `first`
  /// on, of a store with the same tiles.
  void restore(int first, std::span<const uint> offsets, std::span<const uint> irradiance,
               std::span<const uint> distance);

  /// Forgets everything: no light, distances of 0, and probes on the grid.
  void clear();

 private:
  std::vector<ProbeGrid> grids_;
  std::vector<CornerOffsets> corner_table_;
  int probes_ = 0;
  int irradiance_texels_;
  int distance_texels_;
  IrradianceFormat irradiance_format_;
  DistanceFormat distance_format_;
  // Aligned so that a row of a distance tile is one line of the cache.
  std::vector<uint, LargePages<uint>> irradiance_;
  std::vector<uint, LargePages<uint>> distance_;
  std::vector<uint> offsets_;
};

}  // namespace lambent
