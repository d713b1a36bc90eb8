// SPDX-License-Identifier: Apache-2.0
// Which levels to send, so that decoded light is as near to a field's as was asked for. Decoders
// know nothing of this.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lambent/stream.h"
#include "stream/light/light_state.h"
#include "stream/light/tile_basis.h"

namespace lambent::stream {

/// A field's light.
struct FieldLight {
  std::span<const glm::vec4> tiles;  ///< A tile for each probe, one after the other.
  double mean = 0.0;                 ///< Over lit probes, their texels and channels [W/m^2].
};

/// Fails where light is not finite, or not within 0 to 1e14 W/m^2.
Expected<void> check_light(std::span<const glm::vec4> tiles);

/// The light of a field, which check_light accepts.
FieldLight measure_light(const LightLayout& layout, std::span<const glm::vec4> tiles);

/// The coefficients of a field's light, in units.
std::vector<float> coefficients_of(const LightLayout& layout, const TileBasis& basis,
                                   const FieldLight& light, float unit);

/// How far the light of a state is from a field's.
LightErrors errors_of(const LightLayout& layout, const TileBasis& basis, const FieldLight& light,
                      float unit, std::span<const std::int32_t> coefficients);

/// The unit in which light of this mean, rounded to whole units, is well within the target.
float choose_unit(const FieldLight& light, float target_error);

/// A state that holds coefficients as exactly as it can.
LightState rounded_state(const LightLayout& layout, std::span<const float> coefficients,
                         float unit);

/// The levels that bring a state near to coefficients. Of what is wrong by less than a unit or so,
/// what would cost more than it is worth is left out: with a thrift of 0 nothing, with 1 as much as
/// pays where errors are half a unit, with 2 twice as much.
std::vector<std::int32_t> choose_levels(const LightLayout& layout, const LightState& state,
                                        std::span<const float> coefficients, float thrift);

}  // namespace lambent::stream
