// SPDX-License-Identifier: Apache-2.0
// From irradiance to the numbers that are coded, and back.
//
// What is coded is s = sqrt(E): an error of s is one of E that is 2 s as large, so that bright
// light may be off by more than dark light, and dark light by a larger share than bright light.
// Red, green and blue of s become a grey and two differences, and each of these, over the texels of
// a tile, coefficients of the tile's basis.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "stream/light/light_state.h"
#include "stream/light/tile_basis.h"

namespace lambent::stream {

// The largest tile has so many texels.
inline constexpr std::size_t kMaxTileTexels = 16 * 16;

/// Turns tiles of irradiance into coefficients, and back.
class LightSignal {
 public:
  /// A step of the coefficients is `unit` [(W/m^2)^(1/2)].
  LightSignal(const TileBasis& basis, float unit) : basis_(basis), unit_(unit) {}

  /// The coefficients of a tile's light, in units, not rounded: basis.size() of each channel.
  void coefficients_of(std::span<const glm::vec4> tile, std::span<float> coefficients) const;

  /// The light [W/m^2] of coefficients.
  void light_of(std::span<const std::int32_t> coefficients, std::span<glm::vec3> tile) const;

 private:
  const TileBasis& basis_;
  float unit_;
};

}  // namespace lambent::stream
