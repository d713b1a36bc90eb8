// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>

#include "fog/fog.h"

namespace lambent {
namespace {

constexpr int kMaxFroxelPixels = 64;
constexpr int kMinSlices = 4, kMaxSlices = 512;
constexpr int kMaxFroxelSamples = 64;
// Most froxels in a picture; they take 48 bytes each.
constexpr std::int64_t kMaxFroxels = std::int64_t{1} << 27;

Expected<void> check_range(const char* name, int value, int least, int most) {
  if (value >= least && value <= most) return {};
  return fail("", name,
              std::to_string(value) + " is not between " + std::to_string(least) + " and " +
                  std::to_string(most));
}

}  // namespace

Expected<void> check(const FogSettings& s) {
  for (const Expected<void>& fine :
       {check_range("froxel pixels", s.froxel_pixels, 1, kMaxFroxelPixels),
        check_range("fog slices", s.slices, kMinSlices, kMaxSlices),
        check_range("fog samples", s.samples, 1, kMaxFroxelSamples)}) {
    if (!fine) return fine;
  }
  return {};
}

Expected<void> check_froxels(const FogSettings& s, int width, int rows) {
  const auto across = [&](int pixels) {
    return (std::int64_t{pixels} + s.froxel_pixels - 1) / s.froxel_pixels;
  };
  const std::int64_t froxels = across(width) * across(rows) * s.slices;
  if (froxels > kMaxFroxels) {
    return fail("", "froxel pixels",
                "give " + std::to_string(froxels) + " froxels in all, more than 134217728");
  }
  return {};
}

bool has_fog(const Scene& scene) {
  return std::any_of(scene.fog.begin(), scene.fog.end(),
                     [](const FogVolume& fog) { return fog.density > 0.0f; });
}

}  // namespace lambent
