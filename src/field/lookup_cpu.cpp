// SPDX-License-Identifier: Apache-2.0
#include "field/lookup_cpu.h"

#include <cassert>

#include "core/simd.h"
#include "field/irradiance_encoding.h"
#include "field/lookup.h"

// Loops over `k` run over the eight corners of a cell; the compiler turns each into vector
// instructions, so they hold no branches and no calls that are not inlined.
#define LAMBENT_FORCE_INLINE __attribute__((always_inline)) inline

namespace lambent {
namespace {

constexpr int kCorners = 8;

/// What a batch of lookups shares.
struct Tables {
  explicit Tables(const ProbeStore& store)
      : grid(store.grid()),
        offsets(corner_offsets(grid)),
        spacing_min(min(grid.spacing.x, min(grid.spacing.y, grid.spacing.z))),
        distance_words(store.distance_words().data()),
        distance_texels(store.distance_texels()),
        irradiance_words(store.irradiance_words().data()),
        irradiance_texels(store.irradiance_texels()) {}

  ProbeGrid grid;
  CornerOffsets offsets;
  float spacing_min;
  const uint* distance_words;
  int distance_texels;
  const uint* irradiance_words;
  int irradiance_texels;
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
    mean = uintBitsToFloat(words[2 * texel]);
    square = uintBitsToFloat(words[2 * texel + 1]);
  }
}

/// Chebyshev visibility of the biased point from each corner's probe.
template <DistanceFormat format>
LAMBENT_FORCE_INLINE void corner_visibilities(const Tables& t, int base,
                                              const float (&px)[kCorners],
                                              const float (&py)[kCorners],
                                              const float (&pz)[kCorners], const vec3& biased,
                                              float (&visibility)[kCorners]) {
  const float scale = 0.5f * static_cast<float>(t.distance_texels);
  const float last = static_cast<float>(t.distance_texels);
  const int width = t.distance_texels + 2;

  // Find the texel, and the share of its neighbours, of the direction from each probe
  float dist[kCorners], fx[kCorners], fy[kCorners];
  int texel[kCorners];
  for (int k = 0; k < kCorners; ++k) {
    const float x = biased.x - px[k], y = biased.y - py[k], z = biased.z - pz[k];
    dist[k] = std::sqrt(x * x + y * y + z * z);
    const float l1 = std::fabs(x) + std::fabs(y) + std::fabs(z);
    const float inverse = 1.0f / (l1 > 1e-12f ? l1 : 1e-12f);
    const float ox = x * inverse, oy = y * inverse;
    const float folded_x = (1.0f - std::fabs(oy)) * (ox >= 0.0f ? 1.0f : -1.0f);
    const float folded_y = (1.0f - std::fabs(ox)) * (oy >= 0.0f ? 1.0f : -1.0f);
    const float u = ((z < 0.0f ? folded_x : ox) + 1.0f) * scale + 0.5f;
    const float v = ((z < 0.0f ? folded_y : oy) + 1.0f) * scale + 0.5f;
    // u and v lie in [0.5, texels + 0.5], so truncation is floor.
    const int cx = static_cast<int>(u < last ? u : last);
    const int cy = static_cast<int>(v < last ? v : last);
    fx[k] = u - static_cast<float>(cx);
    fy[k] = v - static_cast<float>(cy);
    texel[k] = (base + t.offsets.probe[k]) * (width * width) + cy * width + cx;
  }

  // Interpolate the moments and bound the visibility
  for (int k = 0; k < kCorners; ++k) {
    float m00, m10, m01, m11, s00, s10, s01, s11;
    decode_moments<format>(t.distance_words, texel[k], m00, s00);
    decode_moments<format>(t.distance_words, texel[k] + 1, m10, s10);
    decode_moments<format>(t.distance_words, texel[k] + width, m01, s01);
    decode_moments<format>(t.distance_words, texel[k] + width + 1, m11, s11);
    const float gx = 1.0f - fx[k], gy = 1.0f - fy[k];
    const float mean = (m00 * gx + m10 * fx[k]) * gy + (m01 * gx + m11 * fx[k]) * fy[k];
    const float square = (s00 * gx + s10 * fx[k]) * gy + (s01 * gx + s11 * fx[k]) * fy[k];
    const float variance = std::fabs(square - mean * mean);
    const float beyond = dist[k] - mean;
    const float bound = variance / (variance + beyond * beyond + 1e-20f);
    visibility[k] = beyond <= 0.0f ? 1.0f : bound;
  }
}

template <DistanceFormat format>
LAMBENT_FORCE_INLINE void weigh_corners(const Tables& t, const FieldQuery& query,
                                        CornerWeights& result) {
  const ProbeCell cell = probe_cell(t.grid, query.position_ws);
  const vec3 low = probe_position(t.grid, cell.base);
  const vec3 biased =
      biased_position(query.position_ws, query.normal_ws, query.to_viewer_ws, t.spacing_min);
  result.base = probe_index(t.grid, cell.base);

  float px[kCorners], py[kCorners], pz[kCorners], trilinear[kCorners];
  for (int k = 0; k < kCorners; ++k) {
    px[k] = low.x + ((k & 1) != 0 ? t.grid.spacing.x : 0.0f);
    py[k] = low.y + ((k & 2) != 0 ? t.grid.spacing.y : 0.0f);
    pz[k] = low.z + ((k & 4) != 0 ? t.grid.spacing.z : 0.0f);
    trilinear[k] = ((k & 1) != 0 ? cell.fraction.x : 1.0f - cell.fraction.x) *
                   ((k & 2) != 0 ? cell.fraction.y : 1.0f - cell.fraction.y) *
                   ((k & 4) != 0 ? cell.fraction.z : 1.0f - cell.fraction.z);
  }

  float visibility[kCorners];
  corner_visibilities<format>(t, result.base, px, py, pz, biased, visibility);

  // Weigh each probe by visibility, by its side of the surface and by nearness
  float weight[kCorners];
  for (int k = 0; k < kCorners; ++k) {
    const float x = px[k] - query.position_ws.x;
    const float y = py[k] - query.position_ws.y;
    const float z = pz[k] - query.position_ws.z;
    const float length_squared = x * x + y * y + z * z;
    const float along = x * query.normal_ws.x + y * query.normal_ws.y + z * query.normal_ws.z;
    const float cosine = along / std::sqrt(length_squared > 1e-12f ? length_squared : 1e-12f);
    const float wrap = 0.5f * (cosine + 1.0f);
    const float raw = (wrap * wrap + kWrapFloor) * visibility[k];
    const float crushed = raw * raw * raw * (1.0f / (kCrushThreshold * kCrushThreshold));
    const float chosen = raw < kCrushThreshold ? crushed : raw;
    weight[k] = (chosen > kMinVisibilityWeight ? chosen : kMinVisibilityWeight) * trilinear[k];
  }
  float sum = 0.0f;
  for (int k = 0; k < kCorners; ++k) sum += weight[k];
  const float normalisation = 1.0f / sum;
  for (int k = 0; k < kCorners; ++k) result.weight[k] = weight[k] * normalisation;
}

LAMBENT_SIMD_CLONES void weigh_all_rg16f(const Tables& t, const FieldQuery* queries,
                                         CornerWeights* result, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    weigh_corners<DistanceFormat::rg16f>(t, queries[i], result[i]);
  }
}

LAMBENT_SIMD_CLONES void weigh_all_rg32f(const Tables& t, const FieldQuery* queries,
                                         CornerWeights* result, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    weigh_corners<DistanceFormat::rg32f>(t, queries[i], result[i]);
  }
}

template <IrradianceFormat format>
LAMBENT_FORCE_INLINE vec3 decode_irradiance(const uint* words, int texel) {
  if constexpr (format == IrradianceFormat::rgb9e5) {
    const uint word = words[texel];
    // 2^(exponent - 24), built from its bits: the exponent field is never small enough to be
    // denormal
    const float scale = uintBitsToFloat(((word >> 27u) + (127u - kRgb9e5BiasAndBits)) << 23u);
    return vec3(static_cast<float>(word & 511u), static_cast<float>((word >> 9u) & 511u),
                static_cast<float>((word >> 18u) & 511u)) *
           scale;
  } else if constexpr (format == IrradianceFormat::r11g11b10f) {
    return decode_r11g11b10f(words[texel]);
  } else {
    return {uintBitsToFloat(words[3 * texel]), uintBitsToFloat(words[3 * texel + 1]),
            uintBitsToFloat(words[3 * texel + 2])};
  }
}

/// Weighted irradiance of a cell's probes along the surface normal: all eight are read at the same
/// place of their tile.
template <IrradianceFormat format>
void gather_irradiance(const Tables& t, const FieldQuery* queries, const CornerWeights* weights,
                       vec3* result, std::size_t count) {
  const int width = t.irradiance_texels + 2;
  for (std::size_t i = 0; i < count; ++i) {
    const TileFetch fetch = tile_fetch(queries[i].normal_ws, t.irradiance_texels);
    const vec2 f = fetch.fraction;
    const float shares[4] = {(1.0f - f.x) * (1.0f - f.y), f.x * (1.0f - f.y), (1.0f - f.x) * f.y,
                             f.x * f.y};
    const int first = fetch.corner.y * width + fetch.corner.x;
    vec3 sum(0.0f);
    for (int k = 0; k < kCorners; ++k) {
      const int tile = (weights[i].base + t.offsets.probe[k]) * (width * width) + first;
      vec3 value = decode_irradiance<format>(t.irradiance_words, tile) * shares[0];
      value += decode_irradiance<format>(t.irradiance_words, tile + 1) * shares[1];
      value += decode_irradiance<format>(t.irradiance_words, tile + width) * shares[2];
      value += decode_irradiance<format>(t.irradiance_words, tile + width + 1) * shares[3];
      sum += value * weights[i].weight[k];
    }
    result[i] = sum;
  }
}

}  // namespace

CornerOffsets corner_offsets(const ProbeGrid& grid) {
  CornerOffsets offsets{};
  for (int k = 0; k < kCorners; ++k) offsets.probe[k] = probe_index(grid, cell_corner(k));
  return offsets;
}

void corner_weights(const ProbeStore& store, std::span<const FieldQuery> queries,
                    std::span<CornerWeights> result) {
  assert(queries.size() == result.size());
  const Tables tables(store);
  const auto weigh =
      store.distance_format() == DistanceFormat::rg16f ? weigh_all_rg16f : weigh_all_rg32f;
  weigh(tables, queries.data(), result.data(), queries.size());
}

void lookup_irradiance(const ProbeStore& store, std::span<const FieldQuery> queries,
                       std::span<vec3> result) {
  assert(queries.size() == result.size());
  // Small batches keep the weights between the two kernels in the first-level cache.
  constexpr std::size_t kBatch = 256;
  CornerWeights weights[kBatch];
  const Tables tables(store);
  for (std::size_t first = 0; first < queries.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, queries.size() - first);
    const FieldQuery* batch = queries.data() + first;
    corner_weights(store, {batch, count}, {weights, count});
    switch (store.irradiance_format()) {
      case IrradianceFormat::rgb9e5:
        gather_irradiance<IrradianceFormat::rgb9e5>(tables, batch, weights, &result[first], count);
        break;
      case IrradianceFormat::r11g11b10f:
        gather_irradiance<IrradianceFormat::r11g11b10f>(tables, batch, weights, &result[first],
                                                        count);
        break;
      case IrradianceFormat::float32:
        gather_irradiance<IrradianceFormat::float32>(tables, batch, weights, &result[first], count);
        break;
    }
  }
}

}  // namespace lambent
