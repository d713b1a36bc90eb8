// SPDX-License-Identifier: Apache-2.0
// Based on: Segovia et al., "Non-interleaved Deferred Shading of Interleaved Sample Patterns",
// Graphics Hardware 2006; Gruen and Bavoil, US 9,129,443 B2, 2015.
#include <cmath>
#include "rsm/gather.h"

#include "rsm/texel_light.h"
#include "shared/color.h"
#include "shared/packing.h"
#include "shared/reorient_irradiance.h"

namespace lambent {
namespace {

#define LAMBENT_KERNELS "rsm/gather_kernel.inl.h"
#include "core/simd_levels.inl.h"

}  // namespace

void gather_contiguous(const GatherRow& row, std::span<const RsmTexel> texels) {
  static const auto kernel = LAMBENT_BEST_LEVEL(contiguous);
  kernel(row, texels.data(), texels.size());
}

void gather_scattered(const GatherRow& row, const RsmTexel* rendered,
                      std::span<const std::uint32_t> places) {
  static const auto kernel = LAMBENT_BEST_LEVEL(scattered);
  kernel(row, rendered, places.data(), places.size());
}

void gather_per_pixel(const GatherRow& row, const RsmTexel* texels, const std::uint32_t* places,
                      std::size_t count) {
  static const auto kernel = LAMBENT_BEST_LEVEL(per_pixel);
  kernel(row, texels, places, count);
}

void sum_terms(const ConstPlanes& points, int count, std::span<const RsmTexel> texels,
               TermSums* sums) {
  static const auto kernel = LAMBENT_BEST_LEVEL(add_terms);
  kernel(points, count, texels.data(), texels.size(), sums);
}

void gather_fetched(const GatherRow& row, int first, const float (*fields)[kLanes],
                    bool directions) {
  static const auto kernel = LAMBENT_BEST_LEVEL(add_fetched);
  kernel(row, first, fields, directions);
}

void make_reorientable(const GatherRow& row) {
  static const auto kernel = LAMBENT_BEST_LEVEL(reorientable);
  kernel(row);
}

}  // namespace lambent
