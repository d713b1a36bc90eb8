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

/// The change from one tile to another of the same size.
inline LightChange light_change(TileLight before, TileLight now) {
  struct Tiles {
    TileLight before, now;
    glm::vec3 fetch_before(int texel) const { return before[texel]; }
    glm::vec3 fetch_now(int texel) const { return now[texel]; }
#include "field/probes/tile_light.inl.h"
  };
  return Tiles{before, now}.light_change(static_cast<int>(now.size()));
}

/// The mean square of the change between two tiles, divided by the square of the mean before.
inline float relative_square(TileLight before, TileLight now) {
  const LightChange change = light_change(before, now);
  return mean_relative_square(change.squares, static_cast<int>(now.size()), change.before);
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
