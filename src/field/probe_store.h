// SPDX-License-Identifier: Apache-2.0
// What probes hold between updates: encoded octahedral tiles with gutters.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/large_pages.h"
#include "field/probe_grid.h"
#include "field/tile.h"
#include "lambent/field.h"

namespace lambent {

/// Tiles of all probes, probe after probe; a tile is (texels + 2)^2 texels, row after row, gutter
/// included.
class ProbeStore {
 public:
  ProbeStore(const ProbeGrid& grid, const FieldSettings& settings);

  const ProbeGrid& grid() const { return grid_; }
  int probes() const { return probes_; }
  int irradiance_texels() const { return irradiance_texels_; }
  int distance_texels() const { return distance_texels_; }
  IrradianceFormat irradiance_format() const { return irradiance_format_; }
  DistanceFormat distance_format() const { return distance_format_; }
  /// Of the tiles; offsets take four more a probe.
  std::size_t bytes() const { return 4 * (irradiance_.size() + distance_.size()); }

  /// Where a probe stands: on the grid, or a little off it.
  vec3 probe_position_ws(int probe) const {
    return probe_position(grid_, probe_coords(grid_, probe)) + probe_offset(probe) * grid_.spacing;
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
  void store_irradiance(int probe, std::span<const vec3> interior, uint salt);
  /// Moves a probe's moments a share of the way to new ones, 0 to 1, likewise.
  void blend_moments(int probe, std::span<const vec2> interior, float share, uint salt);

  /// The encoded words, for kernels; `words_per_*_texel` of them a texel. Distances are in units of
  /// distance_unit(grid()).
  std::span<const uint> irradiance_words() const { return irradiance_; }
  std::span<const uint> distance_words() const { return distance_; }
  int words_per_irradiance_texel() const {
    return irradiance_format_ == IrradianceFormat::float32 ? 3 : 1;
  }
  int words_per_distance_texel() const { return distance_format_ == DistanceFormat::rg32f ? 2 : 1; }

  /// Puts back what offset_words, irradiance_words and distance_words told of a store of the same
  /// shape.
  void restore(std::span<const uint> offsets, std::span<const uint> irradiance,
               std::span<const uint> distance);

  /// Forgets everything: no light, distances of 0, and probes on the grid.
  void clear();

 private:
  ProbeGrid grid_;
  int probes_;
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
