// SPDX-License-Identifier: Apache-2.0
#include "field/lookup/lookup_cpu.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/simd.h"
#include "field/lookup/lookup.h"
#include "field/probes/irradiance_encoding.h"

// Loops over `k` run over the eight corners of a cell, with the functions of lookup.h that shaders
// call for one corner. The compiler turns each loop into vector instructions, so that they must
// contain neither branches nor calls that are not inlined.
#define LAMBENT_LOOKUP_KERNEL LAMBENT_SIMD_CLONES __attribute__((flatten))

namespace lambent {
namespace {

static_assert(kRgb9e5 == static_cast<uint>(IrradianceFormat::rgb9e5) &&
              kR11g11b10f == static_cast<uint>(IrradianceFormat::r11g11b10f) &&
              kIrradianceFloat32 == static_cast<uint>(IrradianceFormat::float32) &&
              kIrradianceFormatCount == kIrradianceFloat32 + 1u);

constexpr int kCorners = kCellCorners;

/// The data that all lookups of a batch in one volume share.
struct Tables {
  Tables(const ProbeStore& store, int volume_index)
      : volume(lookup_grid(store.grid(volume_index))),
        first_table(static_cast<std::uint32_t>(kCellWraps * volume_index)),
        offsets(store.corner_table().data() + first_table),
        offset_words(store.offset_words().data()),
        distance_words(store.distance_words().data()),
        distance_texels(store.distance_texels()) {}

  LookupGrid volume;
  std::uint32_t first_table;     // the volume's first entry in the store's corner table
  const CornerOffsets* offsets;  // the volume's entries, by cell_wrap
  const uint* offset_words;
  const uint* distance_words;
  int distance_texels;
};

template <DistanceFormat format>
LAMBENT_FORCE_INLINE vec2 decode_moments(const uint* words, int texel) {
  if constexpr (format == DistanceFormat::rg16f) {
    const uint word = words[texel];
    return {decode_small_float(word & 0x7FFFu, 10),
            decode_small_float((word >> 16u) & 0x7FFFu, 10)};
  } else {
    const uint* pair = words + 2 * static_cast<std::ptrdiff_t>(texel);
    return {uintBitsToFloat(pair[0]), uintBitsToFloat(pair[1])};
  }
}

/// The state of a lookup between its two halves: the data of the eight corners before their moments
/// are read.
struct CornerFetch {
  int base;
  int wraps;            // cell_wrap()
  int texel[kCorners];  // index of the first of the four texels in the store
  float fraction_x[kCorners], fraction_y[kCorners];
  float dist[kCorners];  // from the probe to the biased point [distance_unit]
  float trilinear[kCorners];
  float wrap[kCorners];  // wrap_weight()
};

/// First half of a lookup: computes which texels to read for each corner, and the weights that need
/// no texels.
template <std::ptrdiff_t words_per_texel>
LAMBENT_FORCE_INLINE void locate_corners(const Tables& t, const FieldQuery& query,
                                         CornerFetch& __restrict fetch) {
  const LookupCell cell = lookup_cell(t.volume, query.position_ws, query.normal_ws,
                                      query.to_viewer_ws, query.viewer_distance);
  const int base = probe_index(t.volume.grid, cell.cell.base);
  const int width = t.distance_texels + 2;
  fetch.base = base;
  fetch.wraps = cell_wrap(t.volume.grid, cell.cell.base);
  const CornerOffsets& offsets = t.offsets[fetch.wraps];

  for (int k = 0; k < kCorners; ++k) {
    const vec3 offset = decode_probe_offset(t.offset_words[base + offsets.probe[k]]);
    const LookupCorner corner =
        lookup_corner(t.volume, cell, cell_corner(k), offset, query.position_ws, query.normal_ws);
    const TileFetch at = moments_fetch(corner.from_probe, t.distance_texels);
    fetch.dist[k] = corner.dist;
    fetch.trilinear[k] = corner.trilinear;
    fetch.wrap[k] = corner.wrap;
    fetch.fraction_x[k] = at.fraction.x;
    fetch.fraction_y[k] = at.fraction.y;
    fetch.texel[k] =
        (base + offsets.probe[k]) * (width * width) + at.corner.y * width + at.corner.x;
  }

  // Prefetch the texels: the store is larger than the nearer caches
  for (int k = 0; k < kCorners; ++k) {
    __builtin_prefetch(t.distance_words + words_per_texel * fetch.texel[k]);
    __builtin_prefetch(t.distance_words + words_per_texel * (fetch.texel[k] + width));
  }
}

/// The moments of a corner.
template <DistanceFormat format>
LAMBENT_FORCE_INLINE vec2 moments_of(const Tables& t, const CornerFetch& fetch, int k) {
  const int width = t.distance_texels + 2;
  return bilinear_moments(decode_moments<format>(t.distance_words, fetch.texel[k]),
                          decode_moments<format>(t.distance_words, fetch.texel[k] + 1),
                          decode_moments<format>(t.distance_words, fetch.texel[k] + width),
                          decode_moments<format>(t.distance_words, fetch.texel[k] + width + 1),
                          vec2(fetch.fraction_x[k], fetch.fraction_y[k]));
}

/// Second half of a lookup: reads the moments and computes the normalised weights of the corners.
template <DistanceFormat format>
LAMBENT_FORCE_INLINE void finish_corners(const Tables& t, const CornerFetch& fetch,
                                         CornerWeights& __restrict result) {
  result.base = fetch.base;
  result.table = t.first_table + static_cast<std::uint32_t>(fetch.wraps);
  for (int k = 0; k < kCorners; ++k) {
    result.weight[k] = corner_weight(fetch.wrap[k], fetch.trilinear[k], fetch.dist[k],
                                     moments_of<format>(t, fetch, k));
  }
  normalize_weights(result);
}

/// Runs each half for several queries in turn, so that the reads of one query overlap with the work
/// on others.
template <DistanceFormat format>
LAMBENT_FORCE_INLINE void weigh_all(const Tables& t, const FieldQuery* queries,
                                    CornerWeights* result, std::size_t count) {
  constexpr std::size_t kAhead = 16;
  constexpr std::ptrdiff_t kWords = format == DistanceFormat::rg16f ? 1 : 2;
  CornerFetch fetches[kAhead];
  for (std::size_t first = 0; first < count; first += kAhead) {
    const std::size_t batch = std::min(kAhead, count - first);
    for (std::size_t i = 0; i < batch; ++i) {
      locate_corners<kWords>(t, queries[first + i], fetches[i]);
    }
    for (std::size_t i = 0; i < batch; ++i) {
      finish_corners<format>(t, fetches[i], result[first + i]);
    }
  }
}

LAMBENT_LOOKUP_KERNEL void weigh_all_rg16f(const Tables& t, const FieldQuery* queries,
                                           CornerWeights* result, std::size_t count) {
  weigh_all<DistanceFormat::rg16f>(t, queries, result, count);
}

LAMBENT_LOOKUP_KERNEL void weigh_all_rg32f(const Tables& t, const FieldQuery* queries,
                                           CornerWeights* result, std::size_t count) {
  weigh_all<DistanceFormat::rg32f>(t, queries, result, count);
}

/// The data that all fetches of irradiance share.
struct IrradianceTables {
  explicit IrradianceTables(const ProbeStore& store)
      : offsets(store.corner_table().data()),
        words(store.irradiance_words().data()),
        texels(store.irradiance_texels()) {}

  const CornerOffsets* offsets;  // of all volumes' cells
  const uint* words;
  int texels;
};

/// Adds the weighted irradiance of a cell's probes along the surface normal. All eight probes are
/// read at the same place of their tiles.
template <uint format>
LAMBENT_FORCE_INLINE void gather_irradiance(const IrradianceTables& t, const FieldQuery* queries,
                                            std::span<const CornerWeights> weights,
                                            const std::uint32_t* query, vec3* result) {
  const int words = words_of_irradiance(format);
  const int width = t.texels + 2;
  const int tile_words = words * width * width;

  for (std::size_t i = 0; i < weights.size(); ++i) {
    const TileFetch fetch = tile_fetch(queries[query[i]].normal_ws, t.texels);
    const vec2 f = fetch.fraction;
    const float tap_weights[4] = {(1.0f - f.x) * (1.0f - f.y), f.x * (1.0f - f.y),
                                  (1.0f - f.x) * f.y, f.x * f.y};
    const uint* first = t.words + static_cast<std::ptrdiff_t>(tile_words) * weights[i].base +
                        words * (fetch.corner.y * width + fetch.corner.x);
    const int steps[4] = {0, words, words * width, words * (width + 1)};
    int tile_offset[kCorners];
    const CornerOffsets& offsets = t.offsets[weights[i].table];
    for (int k = 0; k < kCorners; ++k) tile_offset[k] = tile_words * offsets.probe[k];

    // Read the four texels of each corner's tile
    float red[kCorners] = {}, green[kCorners] = {}, blue[kCorners] = {};
    for (int tap = 0; tap < 4; ++tap) {
      const float tap_weight = tap_weights[tap];
      for (int k = 0; k < kCorners; ++k) {
        const uint* texel = first + steps[tap] + tile_offset[k];
        const vec3 light = words == 1 ? decode_irradiance(format, *texel)
                                      : vec3(uintBitsToFloat(texel[0]), uintBitsToFloat(texel[1]),
                                             uintBitsToFloat(texel[2]));
        red[k] += tap_weight * light.x;
        green[k] += tap_weight * light.y;
        blue[k] += tap_weight * light.z;
      }
    }

    // Weigh the corners
    vec3 sum(0.0f);
    for (int k = 0; k < kCorners; ++k) {
      sum += vec3(red[k], green[k], blue[k]) * weights[i].weight[k];
    }
    result[query[i]] += sum;
  }
}

LAMBENT_LOOKUP_KERNEL void gather_rgb9e5(const IrradianceTables& t, const FieldQuery* queries,
                                         std::span<const CornerWeights> weights,
                                         const std::uint32_t* query, vec3* result) {
  gather_irradiance<kRgb9e5>(t, queries, weights, query, result);
}

LAMBENT_LOOKUP_KERNEL void gather_r11g11b10f(const IrradianceTables& t, const FieldQuery* queries,
                                             std::span<const CornerWeights> weights,
                                             const std::uint32_t* query, vec3* result) {
  gather_irradiance<kR11g11b10f>(t, queries, weights, query, result);
}

LAMBENT_LOOKUP_KERNEL void gather_float32(const IrradianceTables& t, const FieldQuery* queries,
                                          std::span<const CornerWeights> weights,
                                          const std::uint32_t* query, vec3* result) {
  gather_irradiance<kIrradianceFloat32>(t, queries, weights, query, result);
}

}  // namespace

void corner_weights(const ProbeStore& store, int volume, std::span<const FieldQuery> queries,
                    std::span<CornerWeights> result) {
  assert(queries.size() == result.size());
  const Tables tables(store, volume);
  const auto weigh =
      store.distance_format() == DistanceFormat::rg16f ? weigh_all_rg16f : weigh_all_rg32f;
  weigh(tables, queries.data(), result.data(), queries.size());
}

void add_irradiance(const ProbeStore& store, std::span<const FieldQuery> queries,
                    std::span<const CornerWeights> weights, std::span<const std::uint32_t> query,
                    std::span<vec3> result) {
  assert(queries.size() == result.size() && weights.size() == query.size());
  const IrradianceTables tables(store);
  const auto gather = store.irradiance_format() == IrradianceFormat::rgb9e5 ? gather_rgb9e5
                      : store.irradiance_format() == IrradianceFormat::r11g11b10f
                          ? gather_r11g11b10f
                          : gather_float32;
  gather(tables, queries.data(), weights, query.data(), result.data());
}

}  // namespace lambent
