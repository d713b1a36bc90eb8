// SPDX-License-Identifier: Apache-2.0
#include "field/lookup/lookup_cpu.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/simd.h"
#include "field/lookup/lookup.h"
#include "field/probes/irradiance_encoding.h"

// Loops over `k` run over the eight corners of a cell. The compiler turns each of them into vector
// instructions, so that they must contain neither branches nor calls that are not inlined.

namespace lambent {
namespace {

constexpr int kCorners = kCellCorners;

// These keep divisions finite: at a probe's own place [m^2 and m], and where distances have no
// variance [distance_unit^2]. They are far below the resolution of the results.
const float kMinLengthSquared = kMinProbeDistance * kMinProbeDistance;
constexpr float kTiniestLength = 1e-12f;
constexpr float kTiniestSquare = 1e-20f;

/// Everything that the lookups of a batch in one volume have in common.
struct Tables {
  Tables(const ProbeStore& store, int volume)
      : grid(store.grid(volume)),
        first_table(static_cast<std::uint32_t>(kCellWraps * volume)),
        offsets(store.corner_table().data() + first_table),
        distances_per_metre(1.0f / distance_unit(grid)),
        spacing_min(smallest_spacing(grid)),
        offset_words(store.offset_words().data()),
        distance_words(store.distance_words().data()),
        distance_texels(store.distance_texels()) {}

  ProbeGrid grid;
  std::uint32_t first_table;     // the volume's first entry in the store's corner table
  const CornerOffsets* offsets;  // the volume's entries, by cell_wrap
  float distances_per_metre;     // units of the stored distances in a metre
  float spacing_min;
  const uint* offset_words;
  const uint* distance_words;
  int distance_texels;
};

/// decode_small_float for a half, without a branch.
LAMBENT_FORCE_INLINE float decode_half(uint bits) {
  const float value = uintBitsToFloat((bits << 13u) + (kSmallFloatBiasShift << 23u));
  return bits == 0u ? 0.0f : value;
}

template <DistanceFormat format>
LAMBENT_FORCE_INLINE void decode_moments(const uint* words, int texel, float& mean, float& square) {
  if constexpr (format == DistanceFormat::rg16f) {
    const uint word = words[texel];
    mean = decode_half(word & 0x7FFFu);
    square = decode_half((word >> 16u) & 0x7FFFu);
  } else {
    const uint* pair = words + 2 * static_cast<std::ptrdiff_t>(texel);
    mean = uintBitsToFloat(pair[0]);
    square = uintBitsToFloat(pair[1]);
  }
}

/// The state of a lookup between its two halves: what is known of the eight corners before their
/// moments are read.
struct CornerFetch {
  int base;
  int run_over;         // cell_wrap
  int texel[kCorners];  // index of the first of the four texels in the store
  float fraction_x[kCorners], fraction_y[kCorners];
  float dist[kCorners];  // from the probe to the biased point [distance_unit]
  float trilinear[kCorners];
  float wrap[kCorners];  // weight by the probe's side of the surface
};

/// First half of a lookup: computes which texels to read for each corner, and the weights that need
/// no texels.
template <std::ptrdiff_t words_per_texel>
LAMBENT_FORCE_INLINE void locate_corners(const Tables& t, const FieldQuery& query,
                                         CornerFetch& __restrict fetch) {
  const ProbeCell cell = probe_cell(t.grid, query.position_ws);
  const vec3 low = probe_position(t.grid, cell.base);
  const vec3 position = query.position_ws, normal = query.normal_ws;
  const vec3 biased = biased_position(position, normal, query.to_viewer_ws, t.spacing_min);
  const int base = probe_index(t.grid, cell.base);
  const float last = static_cast<float>(t.distance_texels);
  const float scale = 0.5f * last;
  const int width = t.distance_texels + 2;
  const vec3 spacing = t.grid.spacing;
  const vec3 ax = t.grid.axes[0], ay = t.grid.axes[1], az = t.grid.axes[2];
  fetch.base = base;
  fetch.run_over = cell_wrap(t.grid, cell.base);
  const CornerOffsets& offsets = t.offsets[fetch.run_over];

  for (int k = 0; k < kCorners; ++k) {
    const vec3 offset = decode_probe_offset(t.offset_words[base + offsets.probe[k]]);
    const float lx = ((k & 1) != 0 ? spacing.x : 0.0f) + offset.x * spacing.x;
    const float ly = ((k & 2) != 0 ? spacing.y : 0.0f) + offset.y * spacing.y;
    const float lz = ((k & 4) != 0 ? spacing.z : 0.0f) + offset.z * spacing.z;
    const float px = low.x + (ax.x * lx + ay.x * ly + az.x * lz);
    const float py = low.y + (ax.y * lx + ay.y * ly + az.y * lz);
    const float pz = low.z + (ax.z * lx + ay.z * ly + az.z * lz);
    fetch.trilinear[k] = ((k & 1) != 0 ? cell.fraction.x : 1.0f - cell.fraction.x) *
                         ((k & 2) != 0 ? cell.fraction.y : 1.0f - cell.fraction.y) *
                         ((k & 4) != 0 ? cell.fraction.z : 1.0f - cell.fraction.z);

    // Compute on which side of the surface the probe is
    const float tx = px - position.x, ty = py - position.y, tz = pz - position.z;
    const float length_squared = tx * tx + ty * ty + tz * tz;
    const float along = tx * normal.x + ty * normal.y + tz * normal.z;
    const float cosine = along / std::sqrt(std::max(kMinLengthSquared, length_squared));
    fetch.wrap[k] = wrap_weight(cosine);

    // Compute the texels and bilinear weights for the direction from the probe
    const float x = biased.x - px, y = biased.y - py, z = biased.z - pz;
    fetch.dist[k] = std::sqrt(x * x + y * y + z * z) * t.distances_per_metre;
    const float l1 = std::fabs(x) + std::fabs(y) + std::fabs(z);
    const float inverse = 1.0f / std::max(kTiniestLength, l1);
    const float ox = x * inverse, oy = y * inverse;
    const float folded_x = (1.0f - std::fabs(oy)) * (ox >= 0.0f ? 1.0f : -1.0f);
    const float folded_y = (1.0f - std::fabs(ox)) * (oy >= 0.0f ? 1.0f : -1.0f);
    const float u = ((z < 0.0f ? folded_x : ox) + 1.0f) * scale + 0.5f;
    const float v = ((z < 0.0f ? folded_y : oy) + 1.0f) * scale + 0.5f;
    // u and v lie in [0.5, texels + 0.5], so truncation is floor.
    const int cx = static_cast<int>(u < last ? u : last);
    const int cy = static_cast<int>(v < last ? v : last);
    fetch.fraction_x[k] = u - static_cast<float>(cx);
    fetch.fraction_y[k] = v - static_cast<float>(cy);
    fetch.texel[k] = (base + offsets.probe[k]) * (width * width) + cy * width + cx;
  }

  // Prefetch the texels: the store is larger than the nearer caches
  for (int k = 0; k < kCorners; ++k) {
    __builtin_prefetch(t.distance_words + words_per_texel * fetch.texel[k]);
    __builtin_prefetch(t.distance_words + words_per_texel * (fetch.texel[k] + width));
  }
}

/// Second half of a lookup: interpolates the moments and computes the visibility of each corner.
/// `known` is 0 for probes inside geometry, else 1.
template <DistanceFormat format>
LAMBENT_FORCE_INLINE void see_corners(const Tables& t, const CornerFetch& fetch,
                                      float* __restrict visibility, float* __restrict known) {
  const int width = t.distance_texels + 2;
  for (int k = 0; k < kCorners; ++k) {
    float m00, m10, m01, m11, s00, s10, s01, s11;
    decode_moments<format>(t.distance_words, fetch.texel[k], m00, s00);
    decode_moments<format>(t.distance_words, fetch.texel[k] + 1, m10, s10);
    decode_moments<format>(t.distance_words, fetch.texel[k] + width, m01, s01);
    decode_moments<format>(t.distance_words, fetch.texel[k] + width + 1, m11, s11);
    const float fx = fetch.fraction_x[k], fy = fetch.fraction_y[k];
    const float gx = 1.0f - fx, gy = 1.0f - fy;
    const float mean = (m00 * gx + m10 * fx) * gy + (m01 * gx + m11 * fx) * fy;
    const float square = (s00 * gx + s10 * fx) * gy + (s01 * gx + s11 * fx) * fy;
    const float variance = std::fabs(square - mean * mean);
    const float beyond = fetch.dist[k] - mean;
    const float bound = variance / (variance + beyond * beyond + kTiniestSquare);
    visibility[k] = beyond <= 0.0f ? 1.0f : bound * bound * bound;
    known[k] = mean > 0.0f ? 1.0f : 0.0f;
  }
}

/// Computes the normalised weights of the corners.
template <DistanceFormat format>
LAMBENT_FORCE_INLINE void weigh_corners(const Tables& t, const CornerFetch& fetch,
                                        CornerWeights& __restrict result) {
  float weight[kCorners], visibility[kCorners], known[kCorners];
  see_corners<format>(t, fetch, visibility, known);
  for (int k = 0; k < kCorners; ++k) {
    const float raw = fetch.wrap[k] * visibility[k];
    const float crushed = raw * raw * raw * (1.0f / (kCrushThreshold * kCrushThreshold));
    const float chosen = raw < kCrushThreshold ? crushed : raw;
    const float floored = chosen > kMinVisibilityWeight ? chosen : kMinVisibilityWeight;
    weight[k] = known[k] * floored * fetch.trilinear[k];
  }
  float sum = 0.0f;
  for (int k = 0; k < kCorners; ++k) sum += weight[k];
  const float normalisation = sum > 0.0f ? 1.0f / sum : 0.0f;
  result.base = fetch.base;
  result.table = t.first_table + static_cast<std::uint32_t>(fetch.run_over);
  for (int k = 0; k < kCorners; ++k) result.weight[k] = weight[k] * normalisation;
}

template <DistanceFormat format>
LAMBENT_FORCE_INLINE void finish_corners(const Tables& t, const CornerFetch& fetch,
                                         CornerWeights& __restrict result) {
  weigh_corners<format>(t, fetch, result);
}

template <DistanceFormat format>
LAMBENT_FORCE_INLINE void finish_corners(const Tables& t, const CornerFetch& fetch,
                                         CornerTerms& __restrict result) {
  float known[kCorners];
  see_corners<format>(t, fetch, result.visibility, known);
  result.base = fetch.base;
  result.table = t.first_table + static_cast<std::uint32_t>(fetch.run_over);
  for (int k = 0; k < kCorners; ++k) {
    result.trilinear[k] = fetch.trilinear[k];
    result.wrap[k] = known[k] * fetch.wrap[k];
  }
}

/// Runs each half for several queries in turn, so that the reads of one query overlap with the work
/// on others.
template <DistanceFormat format, class Result>
LAMBENT_FORCE_INLINE void weigh_all(const Tables& t, const FieldQuery* queries, Result* result,
                                    std::size_t count) {
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

LAMBENT_SIMD_CLONES void weigh_all_rg16f(const Tables& t, const FieldQuery* queries,
                                         CornerWeights* result, std::size_t count) {
  weigh_all<DistanceFormat::rg16f>(t, queries, result, count);
}

LAMBENT_SIMD_CLONES void weigh_all_rg32f(const Tables& t, const FieldQuery* queries,
                                         CornerWeights* result, std::size_t count) {
  weigh_all<DistanceFormat::rg32f>(t, queries, result, count);
}

LAMBENT_SIMD_CLONES void terms_of_all_rg16f(const Tables& t, const FieldQuery* queries,
                                            CornerTerms* result, std::size_t count) {
  weigh_all<DistanceFormat::rg16f>(t, queries, result, count);
}

LAMBENT_SIMD_CLONES void terms_of_all_rg32f(const Tables& t, const FieldQuery* queries,
                                            CornerTerms* result, std::size_t count) {
  weigh_all<DistanceFormat::rg32f>(t, queries, result, count);
}

template <IrradianceFormat format>
LAMBENT_FORCE_INLINE void decode_irradiance(const uint* word, float& r, float& g, float& b) {
  if constexpr (format == IrradianceFormat::rgb9e5) {
    const float scale = power_of_two(static_cast<int>(*word >> 27u) - kRgb9e5BiasAndBits);
    r = static_cast<float>(static_cast<int>(*word & 511u)) * scale;
    g = static_cast<float>(static_cast<int>((*word >> 9u) & 511u)) * scale;
    b = static_cast<float>(static_cast<int>((*word >> 18u) & 511u)) * scale;
  } else if constexpr (format == IrradianceFormat::r11g11b10f) {
    r = linear_from_perceptual(decode_small_float(*word & 0x7FFu, 6));
    g = linear_from_perceptual(decode_small_float((*word >> 11u) & 0x7FFu, 6));
    b = linear_from_perceptual(decode_small_float(*word >> 22u, 5));
  } else {
    r = uintBitsToFloat(word[0]);
    g = uintBitsToFloat(word[1]);
    b = uintBitsToFloat(word[2]);
  }
}

/// Everything that reads of irradiance have in common.
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
template <IrradianceFormat format>
LAMBENT_FORCE_INLINE void gather_irradiance(const IrradianceTables& t, const FieldQuery* queries,
                                            std::span<const CornerWeights> weights,
                                            const std::uint32_t* query, vec3* result) {
  constexpr int kWords = format == IrradianceFormat::float32 ? 3 : 1;
  const int width = t.texels + 2;
  const int tile_words = kWords * width * width;

  for (std::size_t i = 0; i < weights.size(); ++i) {
    const TileFetch fetch = tile_fetch(queries[query[i]].normal_ws, t.texels);
    const vec2 f = fetch.fraction;
    const float tap_weights[4] = {(1.0f - f.x) * (1.0f - f.y), f.x * (1.0f - f.y),
                                  (1.0f - f.x) * f.y, f.x * f.y};
    const uint* first = t.words + static_cast<std::ptrdiff_t>(tile_words) * weights[i].base +
                        kWords * (fetch.corner.y * width + fetch.corner.x);
    const int steps[4] = {0, kWords, kWords * width, kWords * (width + 1)};
    int tile_offset[kCorners];
    const CornerOffsets& offsets = t.offsets[weights[i].table];
    for (int k = 0; k < kCorners; ++k) tile_offset[k] = tile_words * offsets.probe[k];

    // Read the four texels of each corner's tile
    float red[kCorners] = {}, green[kCorners] = {}, blue[kCorners] = {};
    for (int tap = 0; tap < 4; ++tap) {
      const float tap_weight = tap_weights[tap];
      for (int k = 0; k < kCorners; ++k) {
        float r, g, b;
        decode_irradiance<format>(first + steps[tap] + tile_offset[k], r, g, b);
        red[k] += tap_weight * r;
        green[k] += tap_weight * g;
        blue[k] += tap_weight * b;
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

LAMBENT_SIMD_CLONES void gather_rgb9e5(const IrradianceTables& t, const FieldQuery* queries,
                                       std::span<const CornerWeights> weights,
                                       const std::uint32_t* query, vec3* result) {
  gather_irradiance<IrradianceFormat::rgb9e5>(t, queries, weights, query, result);
}

LAMBENT_SIMD_CLONES void gather_r11g11b10f(const IrradianceTables& t, const FieldQuery* queries,
                                           std::span<const CornerWeights> weights,
                                           const std::uint32_t* query, vec3* result) {
  gather_irradiance<IrradianceFormat::r11g11b10f>(t, queries, weights, query, result);
}

LAMBENT_SIMD_CLONES void gather_float32(const IrradianceTables& t, const FieldQuery* queries,
                                        std::span<const CornerWeights> weights,
                                        const std::uint32_t* query, vec3* result) {
  gather_irradiance<IrradianceFormat::float32>(t, queries, weights, query, result);
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

void corner_terms(const ProbeStore& store, int volume, std::span<const FieldQuery> queries,
                  std::span<CornerTerms> result) {
  assert(queries.size() == result.size());
  const Tables tables(store, volume);
  const auto all =
      store.distance_format() == DistanceFormat::rg16f ? terms_of_all_rg16f : terms_of_all_rg32f;
  all(tables, queries.data(), result.data(), queries.size());
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
