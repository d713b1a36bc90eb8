// SPDX-License-Identifier: Apache-2.0
// Based on: Segovia et al., "Non-interleaved Deferred Shading of Interleaved Sample Patterns",
// Graphics Hardware 2006; Gruen and Bavoil, US 9,129,443 B2, 2015.
#include "rsm/gather_kernel.h"

namespace lambent {
namespace {

/// Adds texels that all pixels ask alike; texel_at(k) finds the k-th.
template <class TexelAt>
LAMBENT_FORCE_INLINE void gather_alike(const GatherRow& row, std::size_t count,
                                       const TexelAt& texel_at) {
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes pixels;
    load_pixels(pixels, row, i);
    for (std::size_t k = 0; k < count; ++k) {
      const RsmTexel& t = texel_at(k);
      add_texel(pixels, t.position_ws.x, t.position_ws.y, t.position_ws.z, t.normal_ws.x,
                t.normal_ws.y, t.normal_ws.z, t.softening, t.flux.x * kInvPi, t.flux.y * kInvPi,
                t.flux.z * kInvPi);
    }
    store_light(pixels, row, i);
  }
}

LAMBENT_SIMD_CLONES void contiguous(const GatherRow& row, const RsmTexel* texels,
                                    std::size_t count) {
  gather_alike(row, count, [=](std::size_t k) -> const RsmTexel& { return texels[k]; });
}

LAMBENT_SIMD_CLONES void scattered(const GatherRow& row, const RsmTexel* rendered,
                                   const std::uint32_t* places, std::size_t count) {
  gather_alike(row, count, [=](std::size_t k) -> const RsmTexel& { return rendered[places[k]]; });
}

/// A field of the texels that lanes ask for: `floats` points to that field of the first texel.
LAMBENT_FORCE_INLINE void fetch(Lanes& lanes, const float* floats, const std::uint32_t* places) {
  constexpr std::size_t kStride = sizeof(RsmTexel) / sizeof(float);
  float values[kLanes];
  for (int l = 0; l < kLanes; ++l) values[l] = floats[places[l] * kStride];
  load(lanes, values);
}

LAMBENT_SIMD_CLONES void per_pixel(const GatherRow& row, const RsmTexel* texels,
                                   const std::uint32_t* places, std::size_t count) {
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes pixels;
    load_pixels(pixels, row, i);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t* at = places + k * kLanes;
      Lanes x, y, z, nx, ny, nz, softening, red, green, blue;
      fetch(x, &texels->position_ws.x, at);
      fetch(y, &texels->position_ws.y, at);
      fetch(z, &texels->position_ws.z, at);
      fetch(nx, &texels->normal_ws.x, at);
      fetch(ny, &texels->normal_ws.y, at);
      fetch(nz, &texels->normal_ws.z, at);
      fetch(softening, &texels->softening, at);
      fetch(red, &texels->flux.x, at);
      fetch(green, &texels->flux.y, at);
      fetch(blue, &texels->flux.z, at);
      add_texel<Lanes>(pixels, x, y, z, nx, ny, nz, softening, red * kInvPi, green * kInvPi,
                       blue * kInvPi);
    }
    store_light(pixels, row, i);
  }
}

}  // namespace

void gather_contiguous(const GatherRow& row, std::span<const RsmTexel> texels) {
  contiguous(row, texels.data(), texels.size());
}

void gather_scattered(const GatherRow& row, const RsmTexel* rendered,
                      std::span<const std::uint32_t> places) {
  scattered(row, rendered, places.data(), places.size());
}

void gather_per_pixel(const GatherRow& row, const RsmTexel* texels, const std::uint32_t* places,
                      std::size_t count) {
  per_pixel(row, texels, places, count);
}

}  // namespace lambent
