// SPDX-License-Identifier: Apache-2.0
#include "scene/sky_levels.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "scene/latitude_longitude.h"

namespace lambent {
namespace {

/// How much of texel `index` lies within `low` to `high` [texels].
double overlap(int index, double low, double high) {
  return std::min(index + 1.0, high) - std::max<double>(index, low);
}

/// The next level of a map. Where sizes are odd, texels share those of the finer level.
Image coarser_level(const Image& fine, int width, int height) {
  Image coarse(width, height, 3);
  const double columns = static_cast<double>(fine.width) / width;
  const double rows = static_cast<double>(fine.height) / height;
  parallel_chunks(static_cast<std::size_t>(height), 1, [&](std::size_t row, std::size_t) {
    const int y = static_cast<int>(row);
    const double top = y * rows, bottom = std::min(top + rows, 1.0 * fine.height);
    for (int x = 0; x < width; ++x) {
      const double left = x * columns, right = std::min(left + columns, 1.0 * fine.width);
      glm::dvec3 sum(0.0);
      double weights = 0.0;
      for (int v = static_cast<int>(top); v < bottom; ++v) {
        // The solid angle of a row's texels, but for a common factor
        const double angle = std::sin((v + 0.5) * static_cast<double>(kPi) / fine.height);
        for (int u = static_cast<int>(left); u < right; ++u) {
          const double weight = angle * overlap(v, top, bottom) * overlap(u, left, right);
          const float* texel = fine.at(u, v);
          sum += weight * glm::dvec3(texel[0], texel[1], texel[2]);
          weights += weight;
        }
      }
      for (int k = 0; k < 3; ++k) coarse.at(x, y)[k] = static_cast<float>(sum[k] / weights);
    }
  });
  return coarse;
}

}  // namespace

SkyLevels::SkyLevels(const Environment& environment) : environment_(&environment) {
  update();
}

void SkyLevels::update() {
  const Image& map = environment_->map;
  const float* texels = map.empty() ? nullptr : map.pixels.data();
  const bool same = texels == texels_ && environment_->revision == revision_ &&
                    map.width == width_ && map.height == height_;
  if (same) return;
  revision_ = environment_->revision;
  texels_ = texels;
  width_ = map.width;
  height_ = map.height;
  coarser_.clear();
  if (map.empty()) return;
  const int levels = map_level_count(map.height);
  coarser_.reserve(static_cast<std::size_t>(levels));
  for (int k = 1; k < levels; ++k) {
    coarser_.push_back(
        coarser_level(level(k - 1), map_level_size(map.width, k), map_level_size(map.height, k)));
  }
}

}  // namespace lambent
