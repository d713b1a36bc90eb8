// SPDX-License-Identifier: Apache-2.0
#include "scene/sky/sky_levels.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "scene/environment_sampling.h"

namespace lambent {
namespace {

// Luminance above which the sky counts as bright, over its mean luminance. At most half of a map
// can be brighter than twice the mean, so that what counts as bright is always the smaller part,
// which rays of wide lobes find by chance.
constexpr float kBrightSky = 2.0f;

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

/// Mean luminance of a map over the sphere.
double mean_luminance(const Image& map) {
  double sum = 0.0, weights = 0.0;
  for (int y = 0; y < map.height; ++y) {
    const double angle = std::sin((y + 0.5) * static_cast<double>(kPi) / map.height);
    for (int x = 0; x < map.width; ++x) sum += angle * luminance(fetch_map(map, x, y));
    weights += angle * map.width;
  }
  return sum / weights;
}

/// A map without what is brighter than a limit.
Image dimmed(const Image& map, float limit) {
  Image dim(map.width, map.height, 3);
  parallel_chunks(static_cast<std::size_t>(map.height), 1, [&](std::size_t row, std::size_t) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < map.width; ++x) {
      const glm::vec3 texel = fetch_map(map, x, y);
      const glm::vec3 rest = texel - bright_part(texel, limit);
      for (int k = 0; k < 3; ++k) dim.at(x, y)[k] = rest[k];
    }
  });
  return dim;
}

/// The cells of a map with something brighter than a limit, with their weights for probabilities.
std::vector<BrightSkyCell> bright_cells(const Image& map, float limit) {
  std::vector<std::vector<BrightSkyCell>> of_rows(static_cast<std::size_t>(map.height));
  parallel_chunks(of_rows.size(), 1, [&](std::size_t row, std::size_t) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < map.width; ++x) {
      const float weight = bright_weight(map, limit, x, y);
      const auto texel = static_cast<uint>(y) * static_cast<uint>(map.width) + static_cast<uint>(x);
      if (weight > 0.0f) of_rows[row].push_back({0.0f, weight, texel});
    }
  });
  std::vector<BrightSkyCell> cells;
  for (const std::vector<BrightSkyCell>& row : of_rows) {
    cells.insert(cells.end(), row.begin(), row.end());
  }
  return cells;
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
  dim_.clear();
  cells_.clear();
  if (map.empty()) return;
  const int levels = map_level_count(map.height);
  coarser_.reserve(static_cast<std::size_t>(levels));
  for (int k = 1; k < levels; ++k) {
    coarser_.push_back(
        coarser_level(level(k - 1), map_level_size(map.width, k), map_level_size(map.height, k)));
  }
  find_bright_part();
}

/// Finds the cells of the bright part, and the levels of the rest.
void SkyLevels::find_bright_part() {
  const Image& map = environment_->map;
  limit_ = kBrightSky * static_cast<float>(mean_luminance(level(map_level_count(map.height) - 1)));
  cells_ = lambent::bright_cells(map, limit_);
  double total = 0.0;
  for (const BrightSkyCell& cell : cells_) total += cell.probability;
  if (total <= 0.0) {
    cells_.clear();
    return;
  }
  total_ = static_cast<float>(total);
  double sum = 0.0;
  for (BrightSkyCell& cell : cells_) {
    sum += cell.probability;
    cell.cumulative = static_cast<float>(sum / total);
    cell.probability = static_cast<float>(cell.probability / total);
  }
  Image finer = dimmed(map, limit_);
  for (int k = 1; k < map_level_count(map.height); ++k) {
    dim_.push_back(
        coarser_level(finer, map_level_size(map.width, k), map_level_size(map.height, k)));
    finer = dim_.back();
  }
}

}  // namespace lambent
