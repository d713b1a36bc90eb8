// SPDX-License-Identifier: Apache-2.0
#include "core/cross_bilateral.h"

#include "core/simd_levels.h"
#include "shared/cross_bilateral.h"

namespace lambent {
namespace {

#define LAMBENT_KERNELS "core/cross_bilateral_kernel.inl.h"
#include "core/simd_levels.inl.h"

}  // namespace

PlaneLayout::PlaneLayout(int picture_width, int picture_height, int guard_width)
    : width(picture_width), height(picture_height), guard(guard_width) {
  // A guard between rows serves the end of one and the start of the next
  stride = (width + guard + kLanes - 1) / kLanes * kLanes;
  size = row(height + guard) + kLanes;
}

std::vector<BlurTap> box_taps(int radius) {
  std::vector<BlurTap> taps;
  for (int i = 1; i <= radius; ++i) taps.push_back({i, 1.0f});
  return taps;
}

std::vector<BlurTap> period_taps(int period) {
  // Of an even period the outermost two share a place
  std::vector<BlurTap> taps = box_taps(period / 2);
  if (period % 2 == 0) taps.back().weight = 0.5f;
  return taps;
}

void cross_bilateral_row(const BlurSource& here, std::span<const BlurSource> neighbours,
                         const LightPlanes& out, int count, float plane_tolerance) {
  static const auto kernel = LAMBENT_BEST_LEVEL(blur_row);
  kernel(here, neighbours.data(), neighbours.size(), out, count, 1.0f / plane_tolerance);
}

}  // namespace lambent
