// SPDX-License-Identifier: Apache-2.0
// Measures of the difference between the light of two tiles. Tiles are spans of linear irradiance
// of equal length.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "field/probes/tile_light_math.h"
#include "shared/color.h"

namespace lambent {

using TileLight = std::span<const glm::vec4>;

/// The mean luminance of a tile's texels.
inline float mean_luminance(TileLight tile) {
  float sum = 0.0f;
  for (const glm::vec4& texel : tile) sum += luminance(glm::vec3(texel));
  return sum / static_cast<float>(tile.size());
}

/// The mean square of the difference between two tiles, over the square of the second tile's mean
/// or of `darkest`, whichever is larger.
inline float relative_square(TileLight a, TileLight b, float darkest = 0.0f) {
  float sum = 0.0f;
  for (std::size_t t = 0; t < a.size(); ++t) {
    const float difference = luminance(glm::vec3(a[t] - b[t]));
    sum += difference * difference;
  }
  const float mean = glm::max(mean_luminance(b), darkest);
  return mean_relative_square(sum, static_cast<int>(a.size()), mean);
}

/// The similarity of two tiles' distributions of light over directions. See likeness_of().
inline float likeness(TileLight a, TileLight b) {
  const float mean_a = mean_luminance(a), mean_b = mean_luminance(b);
  LikenessSums sums{};
  for (std::size_t t = 0; t < a.size(); ++t) {
    sums = add_likeness(sums, glm::vec3(a[t]), mean_a, glm::vec3(b[t]), mean_b);
  }
  return likeness_of(sums, mean_a, mean_b);
}

}  // namespace lambent
