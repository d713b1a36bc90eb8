// SPDX-License-Identifier: Apache-2.0
// The current geometry of a field, and its changes since it was sent.
#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/simd.h"
#include "field/field_access.h"
#include "field/field_state.h"
#include "stream/light/geometry.h"

namespace lambent::stream {
namespace {

constexpr std::size_t kChunk = 64;  // probes per task

constexpr std::size_t kMaxEdge = FieldGeometry::kMaxDistanceTexels;

/// The moments of a tile without its gutter, row after row: mean distances [m] and mean squares of
/// distances [m^2].
struct TileMoments {
  std::array<float, kMaxEdge * kMaxEdge> means, squares;
};

/// Decodes a row of texels in half floats, whose unit is `unit` [m].
LAMBENT_SIMD_CLONES void decode_row(const uint* words, int count, float unit, float* means,
                                    float* squares) {
  for (int x = 0; x < count; ++x) {
    const vec2 moments = decode_half2(words[x]);
    means[x] = moments.x * unit;
    squares[x] = moments.y * (unit * unit);
  }
}

/// Reads the tile of a probe.
void read_tile(const ProbeStore& store, const ProbeGrid& grid, int probe, TileMoments& tile) {
  const int n = store.distance_texels(), words = store.words_per_distance_texel();
  const float unit = distance_unit(grid);
  const uint* row = &store.distance_words()[static_cast<std::size_t>(probe) * (n + 2) * (n + 2) *
                                            static_cast<std::size_t>(words)];
  row += (n + 3) * words;  // the gutter's first row, and first texel of the next one
  for (int y = 0; y < n; ++y, row += (n + 2) * words) {
    float *means = &tile.means[y * n], *squares = &tile.squares[y * n];
    if (words == 1) {
      decode_row(row, n, unit, means, squares);
      continue;
    }
    for (int x = 0; x < n; ++x) {
      means[x] = uintBitsToFloat(row[2 * x]) * unit;
      squares[x] = uintBitsToFloat(row[2 * x + 1]) * (unit * unit);
    }
  }
}

void copy_probe(const FieldAccess::State& field, int probe, FieldGeometry& geometry) {
  const ProbeStore& store = field.data.store;
  const ProbeGrid& grid = store.grid_of(probe);
  const float longest = max_probe_distance(grid);
  geometry.offsets[probe] = store.offset_words()[probe];
  geometry.states[probe] = field.statuses[probe].state;
  TileMoments tile;
  read_tile(store, grid, probe, tile);
  for (std::size_t t = 0; t < geometry.tile(); ++t) {
    geometry.moments[probe * geometry.tile() + t] =
        encode_moments({tile.means[t], tile.squares[t]}, longest);
  }
}

bool is_lit(ProbeState state) {
  return state != ProbeState::off;
}

/// Replaces the moments of a tile by the square errors [m^2] of the means and of the standard
/// deviations that were sent, `then`.
LAMBENT_SIMD_CLONES void square_errors(const CodedMoments* then, std::size_t texels, float longest,
                                       TileMoments& tile) {
  for (std::size_t t = 0; t < texels; ++t) {
    const float mean = tile.means[t];
    const float deviation = std::sqrt(std::max(tile.squares[t] - mean * mean, 0.0f));
    const float of_mean = mean - decode_mean(then[t], longest);
    const float of_deviation = deviation - decode_deviation(then[t], longest);
    tile.means[t] = of_mean * of_mean;
    tile.squares[t] = of_deviation * of_deviation;
  }
}

/// Whether the error of distances that were sent exceeds the threshold.
bool is_off(const ProbeStore& store, const FieldGeometry& sent, int probe, float threshold) {
  const ProbeGrid& grid = store.grid_of(probe);
  const std::size_t texels = sent.tile();
  TileMoments tile;
  read_tile(store, grid, probe, tile);
  square_errors(sent.tile_of(probe).data(), texels, max_probe_distance(grid), tile);
  const float means = std::reduce(tile.means.begin(), tile.means.begin() + texels);
  const float deviations = std::reduce(tile.squares.begin(), tile.squares.begin() + texels);
  const float most = threshold * smallest_spacing(grid);
  return std::max(means, deviations) > most * most * static_cast<float>(texels);
}

}  // namespace

FieldGeometry kind_of(const IrradianceField& field) {
  const FieldAccess::State& state = FieldAccess::state_of(field);
  const ProbeStore& store = state.data.store;
  FieldGeometry geometry;
  geometry.irradiance_texels = store.irradiance_texels();
  geometry.distance_texels = store.distance_texels();
  for (int v = 0; v < store.volumes(); ++v) {
    geometry.volumes.push_back({store.grid(v), state.volumes.roles[v]});
  }
  return geometry;
}

FieldGeometry geometry_of(const IrradianceField& field) {
  const ProbeStore& store = store_of(field);
  const FieldAccess::State& state = FieldAccess::state_of(field);
  FieldGeometry geometry = kind_of(field);
  geometry.offsets.resize(store.probes());
  geometry.states.resize(store.probes());
  geometry.moments.resize(store.probes() * geometry.tile());
  parallel_chunks(store.probes(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t probe = begin; probe < end; ++probe) {
      copy_probe(state, static_cast<int>(probe), geometry);
    }
  });
  geometry.corrections = corrections_of(field);
  return geometry;
}

std::vector<CodedCorrectionBlock> corrections_of(const IrradianceField& field) {
  const FieldAccess::State& state = FieldAccess::state_of(field);
  state.backend->fetch_corrections();
  return encode_corrections(state.data.correction.blocks());
}

UpdatedProbes follow(const IrradianceField& field, float threshold, int first, int stride,
                     FieldGeometry& sent) {
  const ProbeStore& store = store_of(field);
  const FieldAccess::State& state = FieldAccess::state_of(field);
  for (int v = 0; v < store.volumes(); ++v) sent.volumes[v].grid = store.grid(v);
  std::vector<std::uint8_t> changed(store.probes());
  parallel_chunks(store.probes(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int probe = static_cast<int>(i);
      const bool moved = store.offset_words()[i] != sent.offsets[i] ||
                         is_lit(state.statuses[i].state) != is_lit(sent.states[i]);
      const bool is_due = probe % stride == first;
      changed[i] = moved || (is_due && is_off(store, sent, probe, threshold)) ? 1 : 0;
    }
  });
  UpdatedProbes updated;
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (changed[probe] == 0) continue;
    updated.probes.push_back(probe);
    const std::span<const CodedMoments> before = sent.tile_of(probe);
    updated.tiles_before.insert(updated.tiles_before.end(), before.begin(), before.end());
  }
  parallel_chunks(updated.probes.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) copy_probe(state, updated.probes[k], sent);
  });
  return updated;
}

}  // namespace lambent::stream
