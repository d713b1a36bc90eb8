// SPDX-License-Identifier: Apache-2.0
// The transform from irradiance to the coded numbers, and back.
//
// The signal is s = sqrt(E): an error of s causes an error of E that is 2 s times as large, so that
// absolute errors are larger in bright light, and relative errors are larger in dark light. Red,
// green and blue of s are transformed to a grey and two differences, and each of these, over the
// texels of a tile, to coefficients of the tile's basis.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "stream/light/light_state.h"
#include "stream/light/tile_basis.h"

namespace lambent::stream {

// Number of texels in the largest tile.
inline constexpr std::size_t kMaxTileTexels = 16 * 16;

/// Transforms tiles of irradiance to coefficients, and back.
class LightSignal {
 public:
  /// A step of the coefficients is `unit` [(W/m^2)^(1/2)].
  LightSignal(const TileBasis& basis, float unit) : basis_(basis), unit_(unit) {}

  /// The coefficients of a tile's light, in units, not rounded: basis.size() per channel.
  void coefficients_of(std::span<const glm::vec4> tile, std::span<float> coefficients) const;

  /// The light [W/m^2] of coefficients.
  void light_of(std::span<const std::int32_t> coefficients, std::span<glm::vec3> tile) const;

 private:
  const TileBasis& basis_;
  float unit_;
};

}  // namespace lambent::stream
