// SPDX-License-Identifier: Apache-2.0
#include "core/cross_bilateral.h"

#include "core/simd_levels.h"
#include "shared/color.h"
#include "shared/cross_bilateral.h"
#include "shared/packing.h"
#include "shared/reorient_irradiance.h"

namespace lambent {
namespace {

#define LAMBENT_KERNELS "core/cross_bilateral_kernel.inl.h"
#include "core/simd_levels.inl.h"

}  // namespace

PlaneLayout::PlaneLayout(int picture_width, int picture_height, int plane_count, int guard_width)
    : width(picture_width), height(picture_height), planes(plane_count), guard(guard_width) {
  // The padding between planes is shared by the end of one and the start of the next
  const auto whole_lanes = [](int count) { return (count + kLanes - 1) / kLanes * kLanes; };
  lead = whole_lanes(guard);
  stride = whole_lanes(width) + lead;
  size = row(height + guard) + kLanes;
}

std::vector<BlurTap> box_taps(int radius) {
  std::vector<BlurTap> taps;
  for (int i = 1; i <= radius; ++i) taps.push_back({i, 1.0f});
  return taps;
}

std::vector<BlurTap> period_taps(int period) {
  // With an even period, the outermost two are the same position
  std::vector<BlurTap> taps = box_taps(period / 2);
  if (period % 2 == 0) taps.back().weight = 0.5f;
  return taps;
}

void cross_bilateral_row(const BlurSource& here, std::span<const BlurSource> neighbours,
                         const Planes& out, int count, float plane_tolerance) {
  static const auto kernel = LAMBENT_BEST_LEVEL(blur_row);
  kernel(here, neighbours.data(), neighbours.size(), out, count, 1.0f / plane_tolerance);
}

void cross_bilateral_row_relit(const BlurSource& here, std::span<const BlurSource> neighbours,
                               const Planes& out, int count, float plane_tolerance) {
  static const auto kernel = LAMBENT_BEST_LEVEL(blur_row_relit);
  kernel(here, neighbours.data(), neighbours.size(), out, count, 1.0f / plane_tolerance);
}

}  // namespace lambent
