// SPDX-License-Identifier: Apache-2.0
// An environment's map at ever lower resolutions, for rays that stand for a cone of directions.
#pragma once

#include <cstdint>
#include <vector>

#include "lambent/scene.h"

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

 private:
  const Environment* environment_;
  std::uint32_t revision_ = 0;
  const float* texels_ = nullptr;  // of the map that the levels were made of
  int width_ = 0, height_ = 0;
  std::vector<Image> coarser_;
};

}  // namespace lambent
