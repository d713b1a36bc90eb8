// SPDX-License-Identifier: Apache-2.0
// An environment's map at ever lower resolutions, for rays that stand for a cone of directions, and
// the cells of its bright part, which is sampled as a light.
#pragma once

#include <cstdint>
#include <vector>

#include "lambent/scene.h"
#include "scene/sky/bright_sky.h"

namespace lambent {

class SkyLevels {
 public:
  /// Lives no longer than the environment.
  explicit SkyLevels(const Environment& environment);

  /// Follows an edit of the environment; levels are computed again where its map is another one.
  void update();

  const Environment& environment() const { return *environment_; }

  /// Level 0 is the map itself, each further one half as wide and high. A texel is the mean of
  /// those that it takes the place of, by their solid angles.
  const Image& level(int index) const {
    return index == 0 ? environment_->map : coarser_[static_cast<std::size_t>(index) - 1];
  }

  /// Whether some of the map is brighter than bright_limit(); the functions below are for those.
  bool has_bright_part() const { return !cells_.empty(); }
  /// Luminance of the map above which it counts as bright [W/(m^2 sr)], without
  /// Environment::radiance.
  float bright_limit() const { return limit_; }
  /// Sum of bright_weight() over the map.
  float bright_total() const { return total_; }
  const std::vector<BrightSkyCell>& bright_cells() const { return cells_; }
  /// A level of the map without its bright part, from 1 on.
  const Image& dim_level(int index) const { return dim_[static_cast<std::size_t>(index) - 1]; }

 private:
  void find_bright_part();

  const Environment* environment_;
  std::uint32_t revision_ = 0;
  const float* texels_ = nullptr;  // of the map that the levels were made of
  int width_ = 0, height_ = 0;
  std::vector<Image> coarser_, dim_;
  float limit_ = 0.0f, total_ = 0.0f;
  std::vector<BrightSkyCell> cells_;
};

}  // namespace lambent
