// SPDX-License-Identifier: Apache-2.0
#include "field/probes/probe_store.h"

#include <algorithm>
#include <cassert>

#include "core/simd.h"
#include "field/probes/irradiance_encoding.h"
#include "field/probes/moments_encoding.h"
#include "shared/random.h"

namespace lambent {
namespace {

// Distinguishes the random numbers of the store's dither from those of other passes.
constexpr uint kStoreSalt = 0x53544F52u;

std::size_t tile_texels(int texels) {
  return static_cast<std::size_t>(texels + 2) * (texels + 2);
}

std::size_t texel_index(int probe, const ivec2& with_gutter, int texels) {
  return static_cast<std::size_t>(probe) * tile_texels(texels) +
         static_cast<std::size_t>(with_gutter.y) * (texels + 2) + with_gutter.x;
}

/// Fills the gutter of a tile with the texels that lie across the octahedron's fold.
void fill_gutter(uint* tile, int texels, int words) {
  const int width = texels + 2;
  for (int i = 0; i < gutter_texels(texels); ++i) {
    const ivec2 at = gutter_texel(i, texels);
    const ivec2 source = tile_source(at, texels) + ivec2(1);
    std::copy_n(tile + (source.y * width + source.x) * words, words,
                tile + (at.y * width + at.x) * words);
  }
}

/// Blends a row of stored moments with new ones. `now` holds pairs of mean and mean square [m,
/// m^2]; a metre is `scale` units of the store. Each texel's dither is a hash of `first_index` plus
/// its place in the row.
LAMBENT_SIMD_CLONES void blend_row_rg16f(uint* words, const float* now, int count,
                                         float blend_weight, float scale, uint first_index) {
  for (int i = 0; i < count; ++i) {
    words[i] = blended_halves(words[i], vec2(now[2 * i], now[2 * i + 1]), blend_weight, scale,
                              first_index + static_cast<uint>(i));
  }
}

LAMBENT_SIMD_CLONES void blend_row_rg32f(uint* words, const float* now, int count,
                                         float blend_weight, float scale, uint /*first_index*/) {
  for (int i = 0; i < count; ++i) {
    const vec2 old(uintBitsToFloat(words[2 * i]), uintBitsToFloat(words[2 * i + 1]));
    const vec2 moments =
        blended_moments(old, vec2(now[2 * i], now[2 * i + 1]), blend_weight, scale);
    words[2 * i] = floatBitsToUint(moments.x);
    words[2 * i + 1] = floatBitsToUint(moments.y);
  }
}

/// Index of each corner of a cell relative to the cell's lowest probe, where the cell wraps around
/// the end of memory in the directions `wrap` (cell_wrap).
CornerOffsets corner_offsets(const ivec3& count, int wrap) {
  const ivec3 row = ivec3(1, count.x, count.x * count.y);
  const ivec3 back = cell_corner(wrap) * count;
  CornerOffsets offsets{};
  for (int k = 0; k < kCellCorners; ++k) {
    const ivec3 step = cell_corner(k) * (ivec3(1) - back) * row;
    offsets.probe[k] = step.x + step.y + step.z;
  }
  return offsets;
}

template <class Value, class Texel>
Value bilinear(const vec3& direction, int texels, Texel texel) {
  const TileFetch fetch = tile_fetch(direction, texels);
  const ivec2 c = fetch.corner;
  const Value top = mix(texel(c), texel(c + ivec2(1, 0)), fetch.fraction.x);
  const Value bottom = mix(texel(c + ivec2(0, 1)), texel(c + ivec2(1, 1)), fetch.fraction.x);
  return mix(top, bottom, fetch.fraction.y);
}

}  // namespace

uint store_dither_seed(uint update, uint seed) {
  return hash_pcg3d(uvec3(update, seed, kStoreSalt)).x;
}

ProbeStore::ProbeStore(std::span<const ProbeGrid> grids, const FieldSettings& settings)
    : grids_(grids.begin(), grids.end()),
      irradiance_texels_(settings.irradiance_texels),
      distance_texels_(settings.distance_texels),
      irradiance_format_(settings.irradiance_format),
      distance_format_(settings.distance_format) {
  for (ProbeGrid& grid : grids_) {
    grid.first = probes_;
    probes_ += probe_count(grid);
    for (int wrap = 0; wrap < kCellWraps; ++wrap)
      corner_table_.push_back(corner_offsets(grid.count, wrap));
  }
  irradiance_.resize(probes_ * tile_texels(irradiance_texels_) * words_per_irradiance_texel());
  distance_.resize(probes_ * tile_texels(distance_texels_) * words_per_distance_texel());
  offsets_.resize(probes_, 0u);
}

int ProbeStore::volume_of(int probe) const {
  int volume = volumes() - 1;
  while (probe < grids_[volume].first) --volume;
  return volume;
}

void ProbeStore::move_volume(int volume, const ProbeGrid& grid) {
  assert(grid.count == grids_[volume].count && grid.spacing == grids_[volume].spacing);
  const int first = grids_[volume].first;
  grids_[volume] = grid;
  grids_[volume].first = first;
}

void ProbeStore::clear() {
  std::fill(irradiance_.begin(), irradiance_.end(), 0u);
  std::fill(distance_.begin(), distance_.end(), 0u);
  std::fill(offsets_.begin(), offsets_.end(), 0u);
}

void ProbeStore::restore(int first, std::span<const uint> offsets, std::span<const uint> irradiance,
                         std::span<const uint> distance) {
  const std::size_t irradiance_tile =
      tile_texels(irradiance_texels_) * words_per_irradiance_texel();
  const std::size_t distance_tile = tile_texels(distance_texels_) * words_per_distance_texel();
  assert(first + offsets.size() <= offsets_.size());
  assert(irradiance.size() == offsets.size() * irradiance_tile);
  assert(distance.size() == offsets.size() * distance_tile);
  std::copy(offsets.begin(), offsets.end(), offsets_.begin() + first);
  std::copy(irradiance.begin(), irradiance.end(), &irradiance_[first * irradiance_tile]);
  std::copy(distance.begin(), distance.end(), &distance_[first * distance_tile]);
}

vec3 ProbeStore::irradiance_texel(int probe, ivec2 with_gutter) const {
  const std::size_t index = texel_index(probe, with_gutter, irradiance_texels_);
  if (words_per_irradiance_texel() == 1) {
    return decode_irradiance(irradiance_code(), irradiance_[index]);
  }
  const uint* words = &irradiance_[3 * index];
  return {uintBitsToFloat(words[0]), uintBitsToFloat(words[1]), uintBitsToFloat(words[2])};
}

vec2 ProbeStore::moments_texel(int probe, ivec2 with_gutter) const {
  const std::size_t index = texel_index(probe, with_gutter, distance_texels_);
  const vec2 moments =
      distance_format_ == DistanceFormat::rg16f
          ? decode_half2(distance_[index])
          : vec2(uintBitsToFloat(distance_[2 * index]), uintBitsToFloat(distance_[2 * index + 1]));
  const float unit = distance_unit(grid_of(probe));
  return moments * vec2(unit, unit * unit);
}

vec3 ProbeStore::irradiance(int probe, const vec3& direction) const {
  return bilinear<vec3>(direction, irradiance_texels_,
                        [&](ivec2 texel) { return irradiance_texel(probe, texel); });
}

vec2 ProbeStore::moments(int probe, const vec3& direction) const {
  return bilinear<vec2>(direction, distance_texels_,
                        [&](ivec2 texel) { return moments_texel(probe, texel); });
}

void ProbeStore::store_irradiance(int probe, std::span<const vec3> interior, uint dither_seed) {
  const int n = irradiance_texels_;
  assert(interior.size() == static_cast<std::size_t>(n) * n);
  const int words = words_per_irradiance_texel();
  for (int t = 0; t < n * n; ++t) {
    const std::size_t index = texel_index(probe, ivec2(t % n, t / n) + ivec2(1), n);
    uint* word = &irradiance_[index * words];
    const vec3 value = interior[t];
    if (words == 3) {
      for (int c = 0; c < 3; ++c) word[c] = floatBitsToUint(value[c]);
      continue;
    }
    const vec3 u = irradiance_dither(static_cast<uint>(index), dither_seed);
    *word = encode_irradiance(irradiance_code(), value, u);
  }
  fill_gutter(&irradiance_[texel_index(probe, {0, 0}, n) * words], n, words);
}

void ProbeStore::blend_moments(int probe, std::span<const vec2> interior, float blend_weight,
                               uint dither_seed) {
  const int n = distance_texels_;
  assert(interior.size() == static_cast<std::size_t>(n) * n);
  const int words = words_per_distance_texel();
  const std::size_t tile = texel_index(probe, {0, 0}, n);
  const float scale = 1.0f / distance_unit(grid_of(probe));
  for (int row = 0; row < n; ++row) {
    const std::size_t first = tile + static_cast<std::size_t>(row + 1) * (n + 2) + 1;
    const auto blend =
        distance_format_ == DistanceFormat::rg16f ? blend_row_rg16f : blend_row_rg32f;
    blend(&distance_[first * words], &interior[static_cast<std::size_t>(row) * n].x, n,
          blend_weight, scale, static_cast<uint>(first) + dither_seed);
  }
  fill_gutter(&distance_[tile * words], n, words);
}

}  // namespace lambent
